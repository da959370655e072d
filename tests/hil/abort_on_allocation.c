/* Preloaded into flexcompd by the tests: ends the process if the real-time thread touches the heap.
 *
 * The thread is known by its name. FLEXCOMP_ABORT_ANYWHERE=1 makes every thread count: the control
 * that shows that the trap works. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

static int must_not_allocate(void) {
  char name[16] = {0};
  prctl(PR_GET_NAME, name);
  return strcmp(name, "flexcomp-rt") == 0 || getenv("FLEXCOMP_ABORT_ANYWHERE") != NULL;
}

static void check(void) {
  static const char message[] = "the real-time thread touched the heap\n";
  if (must_not_allocate()) {
    (void)!write(2, message, sizeof message - 1);
    _exit(99);
  }
}

extern void* __libc_malloc(size_t size);
extern void* __libc_calloc(size_t count, size_t size);
extern void* __libc_realloc(void* old, size_t size);
extern void __libc_free(void* memory);

void* malloc(size_t size) {
  check();
  return __libc_malloc(size);
}

void* calloc(size_t count, size_t size) {
  check();
  return __libc_calloc(count, size);
}

void* realloc(void* old, size_t size) {
  check();
  return __libc_realloc(old, size);
}

void free(void* memory) {
  check();
  __libc_free(memory);
}
