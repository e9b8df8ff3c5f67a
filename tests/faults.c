/* Loaded before libc: call number FAULT_AT of FAULT_CALL fails with FAULT_ERRNO, and with FAULT_EVER all after it. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

static int fails(const char *call) {
  static int count = 0;
  const char *wanted = getenv("FAULT_CALL"), *at = getenv("FAULT_AT");
  if (!wanted || !at || strcmp(wanted, call) != 0) return 0;
  const int n = __atomic_add_fetch(&count, 1, __ATOMIC_SEQ_CST), k = atoi(at);
  if (n != k && !(n > k && getenv("FAULT_EVER"))) return 0;
  const char *reported = getenv("FAULT_SEEN");
  if (reported) {
    int (*open_file)(const char *, int, ...) = (int (*)(const char *, int, ...))dlsym(RTLD_NEXT, "creat");
    (void)open_file(reported, 0600);
  }
  errno = atoi(getenv("FAULT_ERRNO"));
  return 1;
}
#define REAL(name) __typeof__(&name) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

#include <fcntl.h>
#include <unistd.h>
ssize_t write(int file, const void *bytes, size_t size) {
  REAL(write);
  return file > 2 && fails("write") ? -1 : real(file, bytes, size);
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
