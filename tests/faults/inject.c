/* Fails the FAULT_AT-th call of the function named FAULT_CALL (write, fsync, rename, close, open, mmap, malloc) with FAULT_ERRNO,
 * from then on if FAULT_STAYS is set, as a full disk does: LD_PRELOAD=libinject.so FAULT_CALL=write FAULT_AT=3 demcal ...
 * Calls on the standard streams do not count. FAULT_COUNT=FILE: instead, writes the number of calls there at the end. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/types.h>
#include <unistd.h>

static atomic_long calls;
static const char *wanted;
static long at;
static int error, stays, ready;

__attribute__((constructor)) static void begin(void) {
  const char *n = getenv("FAULT_AT"), *e = getenv("FAULT_ERRNO");
  wanted = getenv("FAULT_CALL");
  at = n ? atol(n) : 0;
  error = e ? atoi(e) : ENOSPC;
  stays = getenv("FAULT_STAYS") != NULL;
  ready = 1;
}

static int fails(const char *call) {
  if (!ready || !wanted || strcmp(wanted, call) != 0) return 0;
  const long now = atomic_fetch_add(&calls, 1) + 1;
  if (at == 0 || now < at || (now > at && !stays)) return 0;
  errno = error;
  return 1;
}

__attribute__((destructor)) static void end(void) {
  const char *file = getenv("FAULT_COUNT");
  if (!file) return;
  ready = 0;
  FILE *out = fopen(file, "w");
  if (!out) return;
  fprintf(out, "%ld\n", (long)calls);
  fclose(out);
}

#define REAL(type, name, ...) \
  static type (*real)(__VA_ARGS__); \
  if (!real) real = (type(*)(__VA_ARGS__))dlsym(RTLD_NEXT, name)

ssize_t write(int fd, const void *data, size_t size) {
  REAL(ssize_t, "write", int, const void *, size_t);
  return fd > 2 && fails("write") ? -1 : real(fd, data, size);
}
ssize_t pwrite(int fd, const void *data, size_t size, off_t offset) {
  REAL(ssize_t, "pwrite", int, const void *, size_t, off_t);
  return fd > 2 && fails("write") ? -1 : real(fd, data, size, offset);
}
ssize_t pwrite64(int fd, const void *data, size_t size, off_t offset) {
  REAL(ssize_t, "pwrite64", int, const void *, size_t, off_t);
  return fd > 2 && fails("write") ? -1 : real(fd, data, size, offset);
}
int fsync(int fd) {
  REAL(int, "fsync", int);
  return fails("fsync") ? -1 : real(fd);
}
int rename(const char *from, const char *to) {
  REAL(int, "rename", const char *, const char *);
  return fails("rename") ? -1 : real(from, to);
}
int close(int fd) {
  REAL(int, "close", int);
  if (fd > 2 && fails("close")) {
    real(fd);
    errno = error;
    return -1;
  }
  return real(fd);
}
int open(const char *path, int flags, ...) {
  REAL(int, "open", const char *, int, ...);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return (flags & (O_WRONLY | O_RDWR)) && fails("open") ? -1 : real(path, flags, mode);
}
int open64(const char *path, int flags, ...) {
  REAL(int, "open64", const char *, int, ...);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return (flags & (O_WRONLY | O_RDWR)) && fails("open") ? -1 : real(path, flags, mode);
}
