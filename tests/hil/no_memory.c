/* Preloaded into flexcompd by the tests: while the file named by FLEXCOMP_NO_MEMORY exists, its
 * first thread, which serves signals, gets no memory. */
#define _GNU_SOURCE
#include <errno.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <unistd.h>

extern void* __libc_malloc(size_t size);

void* malloc(size_t size) {
  const char* flag = getenv("FLEXCOMP_NO_MEMORY");
  if (flag != NULL && syscall(SYS_gettid) == getpid() && access(flag, F_OK) == 0) {
    errno = ENOMEM;
    return NULL;
  }
  return __libc_malloc(size);
}
