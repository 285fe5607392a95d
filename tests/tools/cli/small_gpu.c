// Preloaded into the program by a test: makes every device a GPU with memory of its own and with limits.
//
//   MOST_BYTES  of a buffer (CL_DEVICE_MAX_MEM_ALLOC_SIZE)
//   MOST_GROUP  work-items of a group
//   FAIL_AT     the number of a buffer, counted from 1, for which there is no memory; may be unset
//   LOG         a file that gets a line for each buffer that was too large, or for which there was no memory
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t number(const char* name) { return strtoull(getenv(name), NULL, 10); }

static void put(const void* value, size_t value_size, size_t size, void* to, size_t* size_needed) {
  if (to && size >= value_size) memcpy(to, value, value_size);
  if (size_needed) *size_needed = value_size;
}

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t size, void* value, size_t* needed) {
  const cl_device_type type = CL_DEVICE_TYPE_GPU;
  const cl_ulong most = number("MOST_BYTES");
  const size_t group = number("MOST_GROUP");
  const cl_bool no = CL_FALSE;
  switch (what) {
    case CL_DEVICE_TYPE: put(&type, sizeof type, size, value, needed); return CL_SUCCESS;
    case CL_DEVICE_MAX_MEM_ALLOC_SIZE: put(&most, sizeof most, size, value, needed); return CL_SUCCESS;
    case CL_DEVICE_MAX_WORK_GROUP_SIZE: put(&group, sizeof group, size, value, needed); return CL_SUCCESS;
    case CL_DEVICE_HOST_UNIFIED_MEMORY: put(&no, sizeof no, size, value, needed); return CL_SUCCESS;
  }
  cl_int (*real)(cl_device_id, cl_device_info, size_t, void*, size_t*) = dlsym(RTLD_NEXT, "clGetDeviceInfo");
  return real(device, what, size, value, needed);
}

cl_int clGetKernelWorkGroupInfo(cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info what, size_t size, void* value,
                                size_t* needed) {
  const size_t group = number("MOST_GROUP");
  if (what == CL_KERNEL_WORK_GROUP_SIZE) {
    put(&group, sizeof group, size, value, needed);
    return CL_SUCCESS;
  }
  cl_int (*real)(cl_kernel, cl_device_id, cl_kernel_work_group_info, size_t, void*, size_t*) =
      dlsym(RTLD_NEXT, "clGetKernelWorkGroupInfo");
  return real(kernel, device, what, size, value, needed);
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
                              const size_t* global, const size_t* local, cl_uint waits, const cl_event* wait_list,
                              cl_event* event) {
  if (!local || *local > number("MOST_GROUP")) return CL_INVALID_WORK_GROUP_SIZE;
  cl_int (*real)(cl_command_queue, cl_kernel, cl_uint, const size_t*, const size_t*, const size_t*, cl_uint, const cl_event*,
                 cl_event*) = dlsym(RTLD_NEXT, "clEnqueueNDRangeKernel");
  return real(queue, kernel, dimensions, offset, global, local, waits, wait_list, event);
}

static int isNumberedToFail(void) {
  static int made;
  const char* at = getenv("FAIL_AT");
  return at && __atomic_add_fetch(&made, 1, __ATOMIC_RELAXED) == atoi(at);
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* array, cl_int* error) {
  const int in_place = (flags & CL_MEM_USE_HOST_PTR) != 0;
  const int is_too_large = size > number("MOST_BYTES"), fails = isNumberedToFail();
  if (in_place || is_too_large || fails) {
    FILE* log = fopen(getenv("LOG"), "a");
    fprintf(log, "%s %zu\n", in_place ? "in place" : is_too_large ? "too large" : "no memory", size);
    fclose(log);
    if (error)
      *error = in_place ? CL_INVALID_HOST_PTR : is_too_large ? CL_INVALID_BUFFER_SIZE : CL_MEM_OBJECT_ALLOCATION_FAILURE;
    return NULL;
  }
  cl_mem (*real)(cl_context, cl_mem_flags, size_t, void*, cl_int*) = dlsym(RTLD_NEXT, "clCreateBuffer");
  return real(context, flags, size, array, error);
}
