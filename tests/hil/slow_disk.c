/* Preloaded into flexcompd by the tests: a disk that takes 1.5 s to have a file safe. */
#include <unistd.h>

int fsync(int file) {
  (void)file;
  usleep(1500000);
  return 0;
}
