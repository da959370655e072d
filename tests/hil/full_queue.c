/* Preloaded into flexcompd by the tests: while the file named by FLEXCOMP_FULL_QUEUE exists, every
 * sending of frames fails as if the interface's queue were full. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

int sendmmsg(int file, struct mmsghdr* messages, unsigned int count, int flags) {
  static int (*real)(int, struct mmsghdr*, unsigned int, int);
  if (real == NULL) {
    *(void**)&real = dlsym(RTLD_NEXT, "sendmmsg");
  }
  const char* flag = getenv("FLEXCOMP_FULL_QUEUE");
  if (flag != NULL && access(flag, F_OK) == 0) {
    errno = ENOBUFS;
    return -1;
  }
  return real(file, messages, count, flags);
}
