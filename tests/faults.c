/* Loaded before libc: call number FAULT_AT of FAULT_CALL fails with FAULT_ERRNO, and with FAULT_EVER all after it.
   "malloc" stands for all that give memory, to gatewalk and not to gnuplot, which draws on without; "open" for all that
   open a file to read it, "create" to write it, "spawn" for all that start a process. FAULT_SEEN is made where one
   failed. Where gatewalk crashes, FAULT_CRASH has the name of the library, or of the program, that called libc or
   crashed itself; also of a library that ends the program by exit(). */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

static int is_gatewalk(void) { return strncmp(program_invocation_short_name, "gatewalk", 8) == 0; }
static int watches = 0; /* crashes: before that libraries begin, of the program nothing has run */
static void put_crash(const char *name);
static int fails(const char *call) {
  static int count = 0;
  const char *wanted = getenv("FAULT_CALL"), *at = getenv("FAULT_AT");
  if (!wanted || !at || strcmp(wanted, call) != 0) return 0;
  if (strcmp(call, "malloc") == 0 && !is_gatewalk()) return 0;
  const int n = __atomic_add_fetch(&count, 1, __ATOMIC_SEQ_CST), k = atoi(at);
  if (n != k && !(n > k && getenv("FAULT_EVER"))) return 0;
  const char *reported = getenv("FAULT_SEEN");
  if (reported) {
    int (*open_file)(const char *, int, ...) = (int (*)(const char *, int, ...))dlsym(RTLD_NEXT, "creat");
    (void)open_file(reported, 0600);
  }
  if (!watches && getenv("FAULT_CRASH")) put_crash("libraries.so as they begin");
  errno = atoi(getenv("FAULT_ERRNO"));
  return 1;
}

/* glibc's own names: to look them up would take memory. */
extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t), *__libc_memalign(size_t, size_t);
void *malloc(size_t size) { return fails("malloc") ? NULL : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return fails("malloc") ? NULL : __libc_calloc(count, size); }
void *realloc(void *old, size_t size) { return fails("malloc") ? NULL : __libc_realloc(old, size); }
void *aligned_alloc(size_t at, size_t size) { return fails("malloc") ? NULL : __libc_memalign(at, size); }
int posix_memalign(void **to, size_t at, size_t size) {
  void *const p = fails("malloc") ? NULL : __libc_memalign(at, size);
  if (!p) return ENOMEM;
  *to = p;
  return 0;
}
#define REAL(name) __typeof__(&name) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

#include <fcntl.h>
#include <pthread.h>
#include <spawn.h>
#include <stdarg.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
ssize_t write(int file, const void *bytes, size_t size) {
  REAL(write);
  return file > 2 && fails("write") ? -1 : real(file, bytes, size);
}
static void put_crash(const char *name) {
  const int file = (int)syscall(SYS_openat, AT_FDCWD, getenv("FAULT_CRASH"), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0) return;
  (void)syscall(SYS_write, file, name, strlen(name));
  (void)syscall(SYS_close, file);
}
/* Where a library jumped to a place that it never set the stack cannot be walked. */
static const char *jumped = NULL;
void __longjmp_chk(jmp_buf to, int value) {
  static void (*real)(jmp_buf, int) = NULL;
  if (!real) real = (void (*)(jmp_buf, int))dlsym(RTLD_NEXT, "__longjmp_chk");
  Dl_info at;
  if (dladdr(__builtin_return_address(0), &at) && at.dli_fname) jumped = at.dli_fname;
  real(to, value);
  __builtin_unreachable();
}
static void crashed(int number) {
  static int walks = 0;
  if (walks++) {
    put_crash(jumped && strrchr(jumped, '/') ? strrchr(jumped, '/') + 1 : "unknown");
    signal(number, SIG_DFL);
    raise(number);
  }
  void *frames[64];
  char places[1400] = "gatewalk"; /* and where in the program, for addr2line */
  size_t used = strlen(places);
  const int n = backtrace(frames, 64);
  const char *library = NULL; /* called last, unless the program was */
  int own = 0;
  for (int i = 1; i < n && !library; ++i) {
    Dl_info at;
    if (!dladdr(frames[i], &at) || !at.dli_fname) continue;
    const char *slash = strrchr(at.dli_fname, '/'), *name = slash ? slash + 1 : at.dli_fname;
    if (strstr(name, "faults.so") || strncmp(name, "libc.", 5) == 0 || strstr(name, "libstdc++") || strstr(name, "libgcc_s")) continue;
    if (!strstr(name, ".so")) {
      own = 1;
      used += (size_t)sprintf(places + used, " 0x%zx", (size_t)((char *)frames[i] - (char *)at.dli_fbase) - 1);
    } else if (!own) {
      library = name;
    }
  }
  put_crash(library ? library : places);
  signal(number, SIG_DFL);
  raise(number);
}
void exit(int status) {
  REAL(exit);
  Dl_info at;
  if (getenv("FAULT_CRASH") && is_gatewalk() && dladdr(__builtin_return_address(0), &at) && strstr(at.dli_fname, ".so"))
    put_crash(strrchr(at.dli_fname, '/') + 1);
  real(status);
  __builtin_unreachable();
}
__attribute__((constructor)) static void watch_crashes(void) {
  watches = 1;
  if (!getenv("FAULT_CRASH") || !is_gatewalk()) return;
  void *frame;
  (void)backtrace(&frame, 1); /* which loads what it needs */
  static char own[1 << 17]; /* where a library called itself until its stack was full */
  const stack_t stack = {.ss_sp = own, .ss_size = sizeof own};
  (void)sigaltstack(&stack, NULL);
  const struct sigaction action = {.sa_handler = crashed, .sa_flags = SA_ONSTACK | SA_NODEFER};
  const int all[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
  for (unsigned i = 0; i < sizeof all / sizeof *all; ++i) (void)sigaction(all[i], &action, NULL);
}
ssize_t read(int file, void *bytes, size_t size) {
  REAL(read);
  return fails("read") ? -1 : real(file, bytes, size);
}
#define PREAD(name)                                               \
  ssize_t name(int file, void *bytes, size_t size, off_t from) {  \
    REAL(name);                                                   \
    return fails("read") ? -1 : real(file, bytes, size, from);    \
  }
PREAD(pread)
PREAD(pread64)
size_t fread(void *bytes, size_t size, size_t count, FILE *file) {
  REAL(fread);
  if (!fails("read")) return real(bytes, size, count, file);
  file->_flags |= 0x20; /* glibc's mark of an error, which ferror looks at */
  return 0;
}
int close(int file) { /* it is closed, as on Linux */
  REAL(close);
  const int status = real(file);
  return file > 2 && fails("close") ? -1 : status;
}
int link(const char *from, const char *to) {
  REAL(link);
  return fails("link") ? -1 : real(from, to);
}
int fsync(int file) {
  REAL(fsync);
  return fails("fsync") ? -1 : real(file);
}
int fdatasync(int file) {
  REAL(fdatasync);
  return fails("fdatasync") ? -1 : real(file);
}
int rename(const char *from, const char *to) {
  REAL(rename);
  return fails("rename") ? -1 : real(from, to);
}
int ftruncate(int file, off_t size) {
  REAL(ftruncate);
  return fails("ftruncate") ? -1 : real(file, size);
}
static mode_t mode_of(int flags, va_list more) {
  return flags & O_CREAT || (flags & O_TMPFILE) == O_TMPFILE ? va_arg(more, mode_t) : 0;
}
static const char *kind_of(int writes) { return writes ? "create" : "open"; }
#define OPEN(name)                               \
  int name(const char *path, int flags, ...) {   \
    REAL(name);                                  \
    va_list more;                                \
    va_start(more, flags);                       \
    const mode_t mode = mode_of(flags, more);    \
    va_end(more);                                \
    return fails(kind_of(flags & (O_WRONLY | O_RDWR))) ? -1 : real(path, flags, mode); \
  }
#define OPENAT(name)                                    \
  int name(int folder, const char *path, int flags, ...) { \
    REAL(name);                                         \
    va_list more;                                       \
    va_start(more, flags);                              \
    const mode_t mode = mode_of(flags, more);           \
    va_end(more);                                       \
    return fails(kind_of(flags & (O_WRONLY | O_RDWR))) ? -1 : real(folder, path, flags, mode); \
  }
#define FOPEN(name)                                   \
  FILE *name(const char *path, const char *mode) {    \
    REAL(name);                                       \
    return fails(kind_of(strpbrk(mode, "wa+") != NULL)) ? NULL : real(path, mode);   \
  }
OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
FOPEN(fopen)
FOPEN(fopen64)
int memfd_create(const char *name, unsigned flags) {
  REAL(memfd_create);
  return fails("create") ? -1 : real(name, flags);
}
#define SPAWN(name)                                                                                                \
  int name(pid_t *id, const char *file, const posix_spawn_file_actions_t *actions, const posix_spawnattr_t *attributes, \
           char *const words[], char *const environment[]) {                                                       \
    REAL(name);                                                                                                    \
    return fails("spawn") ? atoi(getenv("FAULT_ERRNO")) : real(id, file, actions, attributes, words, environment); \
  }
SPAWN(posix_spawn)
SPAWN(posix_spawnp)
pid_t fork(void) {
  REAL(fork);
  return fails("spawn") ? -1 : real();
}
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*body)(void *), void *argument) {
  REAL(pthread_create);
  return fails("thread") ? EAGAIN : real(thread, attributes, body, argument);
}
