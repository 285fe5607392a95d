// Preloaded into a test by mutate_kernels.py: stands between the program and OpenCL, and hands on each
// program source with one line of one kernel file changed. So a mutant costs neither a build nor a touched
// file.
//
//   MUTANT_FILE  the kernel file, as #line names it: kernels/shade.cl
//   MUTANT_LINE  counted from 1
//   MUTANT_OLD   that line, whole
//   MUTANT_NEW   what it becomes
//   MUTANT_LOG   a file that gets a word for each event: "made" where a source held the line, "stale" where
//   it held another one
//                there, and "built" or "broken" where a changed source was compiled
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static cl_program last_changed;

static void report(const char* event) {
  FILE* log = fopen(getenv("MUTANT_LOG"), "a");
  fprintf(log, "%s\n", event);
  fclose(log);
}

static int equals(const char* text, size_t length, const char* other) {
  return length == strlen(other) && memcmp(text, other, length) == 0;
}

// A copy of the source with the line changed, for the caller to free; *changed: whether the source holds it.
static char* changeLine(const char* source, size_t length, int* changed) {
  const char *file = getenv("MUTANT_FILE"), *old_line = getenv("MUTANT_OLD"),
             *new_line = getenv("MUTANT_NEW");
  const int wanted = atoi(getenv("MUTANT_LINE"));
  char *copy = malloc(length + strlen(new_line) + 1), *end = copy;
  int number = 0, in_file = 0;
  *changed = 0;
  for (const char *line = source, *next; line < source + length; line = next) {
    const char* line_end = memchr(line, '\n', source + length - line);
    next = line_end ? line_end + 1 : source + length;
    const size_t line_length = (line_end ? line_end : next) - line;
    char name[256];
    int named;
    if (strncmp(line, "#line ", 6) == 0 && sscanf(line, "#line %d \"%255[^\"]\"", &named, name) == 2) {
      in_file = strcmp(name, file) == 0;
      number = named - 1;
    } else if (in_file && ++number == wanted && !*changed) {
      if (equals(line, line_length, old_line)) {
        end = stpcpy(end, new_line);
        *end++ = '\n';
        *changed = 1;
        continue;
      }
      report("stale");
    }
    memcpy(end, line, next - line);
    end += next - line;
  }
  *end = 0;
  return copy;
}

cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char** strings,
                                     const size_t* lengths, cl_int* error) {
  cl_program (*original)(cl_context, cl_uint, const char**, const size_t*, cl_int*) =
      dlsym(RTLD_NEXT, "clCreateProgramWithSource");
  // The C++ bindings pass one string.
  if (count != 1) return original(context, count, strings, lengths, error);
  int changed;
  char* source = changeLine(strings[0], lengths && lengths[0] ? lengths[0] : strlen(strings[0]), &changed);
  const cl_program program = original(context, 1, (const char**)&source, NULL, error);
  free(source);
  if (changed) {
    report("made");
    last_changed = program;
  }
  return program;
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices, const char* options,
                      void(CL_CALLBACK* notify)(cl_program, void*), void* data) {
  cl_int (*original)(cl_program, cl_uint, const cl_device_id*, const char*,
                     void(CL_CALLBACK*)(cl_program, void*), void*) = dlsym(RTLD_NEXT, "clBuildProgram");
  const cl_int status = original(program, count, devices, options, notify, data);
  if (program && program == last_changed) report(status == CL_SUCCESS ? "built" : "broken");
  return status;
}
