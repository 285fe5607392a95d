// Preloaded into the program by a test: the call of this number, of all of its kind, fails once. Children of the program are left alone.
//
//   FAIL_KIND    memory, open, read, write, sync, rename, map or close
//   FAIL_AT      the number, counted from 1; 0: none fails
//   FAIL_ERROR   errno's value where it fails; memory: always ENOMEM
//   FAIL_COUNTS  a file that gets the number of calls of each kind, in this order, as int64_t
//
// It allocates nothing, and asks the kernel itself where glibc's own function has no other name. What glibc calls by names of its own
// (read() in fread()) is not seen: so streams fail as a whole, with their error flag; except by EINTR, after which they don't try again.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

enum Kind { MEMORY, OPEN, READ, WRITE, SYNC, RENAME, MAP, CLOSE, KINDS };
static const char* const names[KINDS] = {"memory", "open", "read", "write", "sync", "rename", "map", "close"};

static int64_t none[KINDS];
static int64_t* counts;
static int64_t at;
static int kind = KINDS, error;

static int64_t number(const char* name) { return getenv(name) ? strtoll(getenv(name), NULL, 10) : 0; }

// Runs at the first call of all, which is before any thread is started.
static void start(void) {
  counts = none;
  if (getenv("FAIL_COUNTS")) {
    const long file = syscall(SYS_openat, AT_FDCWD, getenv("FAIL_COUNTS"), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    // Zeros, whatever an earlier run left.
    if (syscall(SYS_ftruncate, file, 0) == 0 && syscall(SYS_ftruncate, file, sizeof none) == 0) {
      int64_t* const map = (int64_t*)syscall(SYS_mmap, NULL, sizeof none, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
      if (map != MAP_FAILED) counts = map;
    }
    syscall(SYS_close, file);
  }
  error = (int)number("FAIL_ERROR");
  at = number("FAIL_AT");
  for (int i = 0; i < KINDS; ++i)
    if (getenv("FAIL_KIND") && !strcmp(getenv("FAIL_KIND"), names[i])) kind = i;
  unsetenv("LD_PRELOAD");
}

/// For a debugger to break at.
__attribute__((noinline)) void failing_call(void) { __asm__ volatile(""); }

static int fails(enum Kind of) {
  if (!counts) start();
  if (__atomic_add_fetch(&counts[of], 1, __ATOMIC_RELAXED) != at || kind != (int)of) return 0;
  failing_call();
  errno = of == MEMORY ? ENOMEM : error;
  return 1;
}

// glibc's functions by their other names.
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* block, size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) { return fails(MEMORY) ? NULL : __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return fails(MEMORY) ? NULL : __libc_calloc(count, size); }
void* realloc(void* block, size_t size) { return size && fails(MEMORY) ? NULL : __libc_realloc(block, size); }
void* memalign(size_t alignment, size_t size) { return fails(MEMORY) ? NULL : __libc_memalign(alignment, size); }
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void** block, size_t alignment, size_t size) {
  void* const found = memalign(alignment, size);
  if (!found) return ENOMEM;
  *block = found;
  return 0;
}

static int opened(int folder, const char* path, int flags, va_list rest) {
  const int mode = flags & O_CREAT || (flags & O_TMPFILE) == O_TMPFILE ? va_arg(rest, int) : 0;
  return fails(OPEN) ? -1 : (int)syscall(SYS_openat, folder, path, flags, mode);
}
#define OPENED(folder)                                     \
  va_list rest;                                            \
  va_start(rest, flags);                                   \
  const int result = opened(folder, path, flags, rest);    \
  va_end(rest);                                            \
  return result
int open(const char* path, int flags, ...) { OPENED(AT_FDCWD); }
int open64(const char* path, int flags, ...) { OPENED(AT_FDCWD); }
int openat(int folder, const char* path, int flags, ...) { OPENED(folder); }
int openat64(int folder, const char* path, int flags, ...) { OPENED(folder); }

ssize_t read(int file, void* bytes, size_t count) { return fails(READ) ? -1 : syscall(SYS_read, file, bytes, count); }
ssize_t pread(int file, void* bytes, size_t count, off_t offset) {
  return fails(READ) ? -1 : syscall(SYS_pread64, file, bytes, count, offset);
}
ssize_t pread64(int file, void* bytes, size_t count, off_t offset) { return pread(file, bytes, count, offset); }
ssize_t write(int file, const void* bytes, size_t count) { return fails(WRITE) ? -1 : syscall(SYS_write, file, bytes, count); }
ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
  return fails(WRITE) ? -1 : syscall(SYS_pwrite64, file, bytes, count, offset);
}
ssize_t pwrite64(int file, const void* bytes, size_t count, off_t offset) { return pwrite(file, bytes, count, offset); }
ssize_t writev(int file, const struct iovec* parts, int count) { return fails(WRITE) ? -1 : syscall(SYS_writev, file, parts, count); }
int fsync(int file) { return fails(SYNC) ? -1 : (int)syscall(SYS_fsync, file); }
int fdatasync(int file) { return fails(SYNC) ? -1 : (int)syscall(SYS_fdatasync, file); }
int rename(const char* from, const char* to) { return fails(RENAME) ? -1 : (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0); }
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  return fails(RENAME) ? -1 : (int)syscall(SYS_renameat2, from_folder, from, to_folder, to, 0);
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
  return fails(RENAME) ? -1 : (int)syscall(SYS_linkat, from_folder, from, to_folder, to, flags);
}
void* mmap(void* address, size_t size, int protection, int flags, int file, off_t offset) {
  return fails(MAP) ? MAP_FAILED : (void*)syscall(SYS_mmap, address, size, protection, flags, file, offset);
}
void* mmap64(void* address, size_t size, int protection, int flags, int file, off_t offset) {
  return mmap(address, size, protection, flags, file, offset);
}
// The file is closed all the same, as Linux does.
int close(int file) {
  const int result = (int)syscall(SYS_close, file);
  return fails(CLOSE) ? -1 : result;
}

static int stream_fails(enum Kind of) { return fails(of) && error != EINTR; }
#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
FILE* fopen(const char* path, const char* mode) { return fails(OPEN) ? NULL : REAL(fopen)(path, mode); }
FILE* fopen64(const char* path, const char* mode) { return fails(OPEN) ? NULL : REAL(fopen64)(path, mode); }
size_t fread(void* bytes, size_t size, size_t count, FILE* stream) {
  if (!stream_fails(READ)) return REAL(fread)(bytes, size, count, stream);
  stream->_flags |= 0x20;  // glibc's _IO_ERR_SEEN
  return 0;
}
size_t fwrite(const void* bytes, size_t size, size_t count, FILE* stream) {
  if (!stream_fails(WRITE)) return REAL(fwrite)(bytes, size, count, stream);
  stream->_flags |= 0x20;
  return 0;
}
int fflush(FILE* stream) {
  if (!stream_fails(WRITE)) return REAL(fflush)(stream);
  if (stream) stream->_flags |= 0x20;
  return EOF;
}
