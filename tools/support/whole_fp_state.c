// Preloaded into user-mode-linux by tools/vcan. Linux takes a process's floating-point registers
// (ptrace, PTRACE_SETREGSET, NT_X86_XSTATE) only whole; the guest kernel knows 2,696 bytes of them,
// and processors with AMX have 11 KiB, so that it could not start a process there. What it sets is
// laid over what the process has; the rest, which no guest uses, stays.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

#include "patient_clock.h"

typedef long ptrace_call(enum __ptrace_request, ...);

static ptrace_call* real_ptrace;
// The guest kernel runs in one thread, on stacks that are too small for it.
static char state[1 << 16];

__attribute__((constructor)) static void find_ptrace(void) {
  real_ptrace = (ptrace_call*)dlsym(RTLD_NEXT, "ptrace");
}

static long set_registers(pid_t pid, const struct iovec* part) {
  struct iovec whole = {state, sizeof state};
  begin_patience();
  if (real_ptrace(PTRACE_GETREGSET, pid, (void*)NT_X86_XSTATE, &whole) != 0 ||
      part->iov_len > whole.iov_len) {
    return real_ptrace(PTRACE_SETREGSET, pid, (void*)NT_X86_XSTATE, part);
  }
  memcpy(state, part->iov_base, part->iov_len);
  return real_ptrace(PTRACE_SETREGSET, pid, (void*)NT_X86_XSTATE, &whole);
}

long ptrace(enum __ptrace_request request, ...) {
  va_list arguments;
  va_start(arguments, request);
  const pid_t pid = va_arg(arguments, pid_t);
  void* address = va_arg(arguments, void*);
  void* data = va_arg(arguments, void*);
  va_end(arguments);
  if (request == PTRACE_SETREGSET && address == (void*)NT_X86_XSTATE) {
    return set_registers(pid, data);
  }
  return real_ptrace(request, pid, address, data);
}
