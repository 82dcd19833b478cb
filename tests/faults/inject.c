/* Fails the FAULT_AT-th call of one kind with FAULT_ERRNO, from then on if FAULT_STAYS is set, as a full disk does:
 * LD_PRELOAD=libinject.so FAULT_CALL=write FAULT_AT=3 demcal ...
 * Kinds: open (to write), write, fsync, close, rename, mkdir, lock, read, malloc, library, mmap, thread, spawn. A kind stands for all calls that
 * do it: write is write, pwrite, writev and fwrite, as glibc's own fwrite calls no write that could be seen from outside.
 * Calls on the standard streams do not count, nor what comes before main. Of malloc those of FAULT_LEAST bytes and more count, of the
 * program and its C++ library; "library" are those of C libraries, whose own fault it is what they do then.
 * FAULT_COUNT=FILE: instead, writes the number of calls there at the end. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

static atomic_long calls;
static const char *wanted;
static long at;
static size_t least;
static int error, stays;
static volatile int ready;

static int fails(const char *call) {
  if (!ready || strcmp(wanted, call) != 0) return 0;
  const long now = atomic_fetch_add(&calls, 1) + 1;
  if (at == 0 || now < at || (now > at && !stays)) return 0;
  errno = error;
  return 1;
}

/* Whether it is a file of the program's, and neither a standard stream nor a pipe within the program, which no disk fills. */
static int is_disk(int fd) {
  struct stat at;
  return ready && fd > 2 && fstat(fd, &at) == 0 && S_ISREG(at.st_mode);
}
static int is_file(FILE *stream) { return is_disk(fileno(stream)); }

#define REAL(type, name, ...) \
  static type (*real)(__VA_ARGS__); \
  if (!real) real = (type(*)(__VA_ARGS__))dlsym(RTLD_NEXT, name)

/* Where the code of the program and of its C++ library lies. */
static struct { char *from, *to; } own[16];
static int owned;
static int find_own(struct dl_phdr_info *object, size_t size, void *ignored) {
  (void)size, (void)ignored;
  if (object->dlpi_name[0] != 0 && !strstr(object->dlpi_name, "libstdc++")) return 0;
  for (int i = 0; i < object->dlpi_phnum && owned < 16; ++i) {
    const ElfW(Phdr) *part = &object->dlpi_phdr[i];
    if (part->p_type != PT_LOAD || !(part->p_flags & PF_X)) continue;
    own[owned].from = (char *)object->dlpi_addr + part->p_vaddr;
    own[owned].to = own[owned].from + part->p_memsz;
    ++owned;
  }
  return 0;
}
static int is_own(const char *caller) {
  for (int i = 0; i < owned; ++i)
    if (caller >= own[i].from && caller < own[i].to) return 1;
  return 0;
}

static int (*program)(int, char **, char **);
static int counted_program(int argc, char **argv, char **environment) {
  wanted = getenv("FAULT_CALL");
  const char *n = getenv("FAULT_AT"), *e = getenv("FAULT_ERRNO"), *l = getenv("FAULT_LEAST");
  at = n ? atol(n) : 0;
  error = e ? atoi(e) : ENOSPC;
  least = l ? (size_t)atol(l) : 0;
  stays = getenv("FAULT_STAYS") != NULL;
  dl_iterate_phdr(find_own, NULL);
  ready = wanted != NULL;
  return program(argc, argv, environment);
}
int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*loader_fini)(void), void *stack) {
  REAL(int, "__libc_start_main", int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void), void *);
  program = main;
  return real(counted_program, argc, argv, init, fini, loader_fini, stack);
}

__attribute__((destructor)) static void end(void) {
  const char *file = getenv("FAULT_COUNT");
  ready = 0;
  if (!file) return;
  FILE *out = fopen(file, "w");
  if (!out) return;
  fprintf(out, "%ld\n", (long)calls);
  fclose(out);
}

ssize_t write(int fd, const void *data, size_t size) {
  REAL(ssize_t, "write", int, const void *, size_t);
  return is_disk(fd) && fails("write") ? -1 : real(fd, data, size);
}
ssize_t pwrite(int fd, const void *data, size_t size, off_t offset) {
  REAL(ssize_t, "pwrite", int, const void *, size_t, off_t);
  return is_disk(fd) && fails("write") ? -1 : real(fd, data, size, offset);
}
ssize_t pwrite64(int fd, const void *data, size_t size, off_t offset) {
  REAL(ssize_t, "pwrite64", int, const void *, size_t, off_t);
  return is_disk(fd) && fails("write") ? -1 : real(fd, data, size, offset);
}
ssize_t writev(int fd, const struct iovec *parts, int count) {
  REAL(ssize_t, "writev", int, const struct iovec *, int);
  return is_disk(fd) && fails("write") ? -1 : real(fd, parts, count);
}
size_t fwrite(const void *data, size_t size, size_t count, FILE *stream) {
  REAL(size_t, "fwrite", const void *, size_t, size_t, FILE *);
  return is_file(stream) && fails("write") ? 0 : real(data, size, count, stream);
}
int ftruncate(int fd, off_t size) {
  REAL(int, "ftruncate", int, off_t);
  return fails("write") ? -1 : real(fd, size);
}
int ftruncate64(int fd, off_t size) {
  REAL(int, "ftruncate64", int, off_t);
  return fails("write") ? -1 : real(fd, size);
}
ssize_t read(int fd, void *data, size_t size) {
  REAL(ssize_t, "read", int, void *, size_t);
  return is_disk(fd) && fails("read") ? -1 : real(fd, data, size);
}
ssize_t pread(int fd, void *data, size_t size, off_t offset) {
  REAL(ssize_t, "pread", int, void *, size_t, off_t);
  return is_disk(fd) && fails("read") ? -1 : real(fd, data, size, offset);
}
ssize_t pread64(int fd, void *data, size_t size, off_t offset) {
  REAL(ssize_t, "pread64", int, void *, size_t, off_t);
  return is_disk(fd) && fails("read") ? -1 : real(fd, data, size, offset);
}
size_t fread(void *data, size_t size, size_t count, FILE *stream) {
  REAL(size_t, "fread", void *, size_t, size_t, FILE *);
  return is_file(stream) && fails("read") ? 0 : real(data, size, count, stream);
}
int fsync(int fd) {
  REAL(int, "fsync", int);
  return fails("fsync") ? -1 : real(fd);
}
int rename(const char *from, const char *to) {
  REAL(int, "rename", const char *, const char *);
  return fails("rename") ? -1 : real(from, to);
}
int mkdir(const char *path, mode_t mode) {
  REAL(int, "mkdir", const char *, mode_t);
  return fails("mkdir") ? -1 : real(path, mode);
}
int flock(int fd, int operation) {
  REAL(int, "flock", int, int);
  return fails("lock") ? -1 : real(fd, operation);
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
int fclose(FILE *stream) {
  REAL(int, "fclose", FILE *);
  if (is_file(stream) && fails("close")) {
    real(stream);
    errno = error;
    return EOF;
  }
  return real(stream);
}
FILE *fopen(const char *path, const char *mode) {
  REAL(FILE *, "fopen", const char *, const char *);
  return strpbrk(mode, "wa+") && fails("open") ? NULL : real(path, mode);
}
FILE *fopen64(const char *path, const char *mode) {
  REAL(FILE *, "fopen64", const char *, const char *);
  return strpbrk(mode, "wa+") && fails("open") ? NULL : real(path, mode);
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
void *mmap(void *address, size_t size, int protection, int flags, int fd, off_t offset) {
  REAL(void *, "mmap", void *, size_t, int, int, int, off_t);
  return fails("mmap") ? MAP_FAILED : real(address, size, protection, flags, fd, offset);
}
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *argument) {
  REAL(int, "pthread_create", pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
  return fails("thread") ? error : real(thread, attributes, run, argument);
}
int posix_spawnp(pid_t *process, const char *file, const posix_spawn_file_actions_t *actions, const posix_spawnattr_t *attributes,
                 char *const argv[], char *const environment[]) {
  REAL(int, "posix_spawnp", pid_t *, const char *, const posix_spawn_file_actions_t *, const posix_spawnattr_t *, char *const[],
       char *const[]);
  return fails("spawn") ? error : real(process, file, actions, attributes, argv, environment);
}

/* dlsym allocates, so these go to glibc's other names. */
extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);
static int refused(size_t size, const char *caller) {
  return ready && size >= least && fails(is_own(caller) ? "malloc" : "library");
}
#define CALLER ((const char *)__builtin_return_address(0))
void *malloc(size_t size) { return refused(size, CALLER) ? NULL : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return refused(count * size, CALLER) ? NULL : __libc_calloc(count, size); }
void *realloc(void *old, size_t size) { return refused(size, CALLER) ? NULL : __libc_realloc(old, size); }
void *aligned_alloc(size_t alignment, size_t size) { return refused(size, CALLER) ? NULL : __libc_memalign(alignment, size); }
int posix_memalign(void **place, size_t alignment, size_t size) {
  if (refused(size, CALLER)) return ENOMEM;
  *place = __libc_memalign(alignment, size);
  return *place ? 0 : ENOMEM;
}
