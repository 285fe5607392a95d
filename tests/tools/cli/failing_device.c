// Preloaded into the program by a test: the device that launches the kernel of this number, of all that are launched, fails from then
// on.
//
//   FAIL_AT   the number, counted from 1
//   FAIL_ALL  set: and every other device, too
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <pthread.h>
#include <stdlib.h>

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;

static int fails(cl_command_queue queue) {
  static int launches;
  static cl_command_queue failed;
  pthread_mutex_lock(&mutex);
  if (++launches >= atoi(getenv("FAIL_AT")) && !failed) failed = queue;
  const int result = failed && (failed == queue || getenv("FAIL_ALL"));
  pthread_mutex_unlock(&mutex);
  return result;
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
                              const size_t* global, const size_t* local, cl_uint waits, const cl_event* wait_list,
                              cl_event* event) {
  if (fails(queue)) return CL_DEVICE_NOT_AVAILABLE;
  cl_int (*real)(cl_command_queue, cl_kernel, cl_uint, const size_t*, const size_t*, const size_t*, cl_uint, const cl_event*,
                 cl_event*) = dlsym(RTLD_NEXT, "clEnqueueNDRangeKernel");
  return real(queue, kernel, dimensions, offset, global, local, waits, wait_list, event);
}
