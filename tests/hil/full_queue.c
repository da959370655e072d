/* Preloaded into flexcompd by the tests: while the file named by FLEXCOMP_FULL_QUEUE exists, every
 * write of a CAN frame fails as if the interface's queue were full. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <linux/can.h>
#include <stdlib.h>
#include <unistd.h>

ssize_t write(int file, const void* data, size_t size) {
  static ssize_t (*real)(int, const void*, size_t);
  if (real == NULL) {
    *(void**)&real = dlsym(RTLD_NEXT, "write");
  }
  const char* flag = getenv("FLEXCOMP_FULL_QUEUE");
  if ((size == CAN_MTU || size == CANFD_MTU) && flag != NULL && access(flag, F_OK) == 0) {
    errno = ENOBUFS;
    return -1;
  }
  return real(file, data, size);
}
