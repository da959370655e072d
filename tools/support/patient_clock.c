// Preloaded into user-mode-linux by tools/vcan: a clock for which a busy machine is fast enough.
// While the guest computes, its time passes FLEXCOMP_GUEST_PATIENCE times slower than this
// machine's; where all its programs wait, it skips to the next of their timers. Begins with the
// first program: while it boots, the kernel measures by the clock.
#define _GNU_SOURCE
#include "patient_clock.h"

#include <dlfcn.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>

enum { kSecond = 1000000000 };  // ns

typedef int gettime_call(clockid_t, struct timespec*);
typedef int settime_call(timer_t, int, const struct itimerspec*, struct itimerspec*);
typedef int suspend_call(const sigset_t*);

static gettime_call* real_gettime;
static settime_call* real_settime;
static suspend_call* real_suspend;
static long long patience = 1;
static long long begin;      // ns, of this machine's clock
static long long skipped;    // ns
static timer_t alarm_clock;  // the guest kernel has one

static long long as_ns(struct timespec time) {
  return time.tv_sec * (long long)kSecond + time.tv_nsec;
}

static struct timespec as_time(long long ns) {
  return (struct timespec){ns / kSecond, ns % kSecond};
}

__attribute__((constructor)) static void find_calls(void) {
  real_gettime = (gettime_call*)dlsym(RTLD_NEXT, "clock_gettime");
  real_settime = (settime_call*)dlsym(RTLD_NEXT, "timer_settime");
  real_suspend = (suspend_call*)dlsym(RTLD_NEXT, "sigsuspend");
}

void begin_patience(void) {
  const char* wanted = getenv("FLEXCOMP_GUEST_PATIENCE");
  struct timespec now;
  if (begin == 0 && wanted != NULL && atoi(wanted) > 1) {
    real_gettime(CLOCK_MONOTONIC, &now);
    begin = as_ns(now);
    patience = atoi(wanted);
  }
}

int clock_gettime(clockid_t clock, struct timespec* time) {
  const int code = real_gettime(clock, time);
  if (code == 0 && clock == CLOCK_MONOTONIC && begin != 0) {
    *time = as_time(begin + (as_ns(*time) - begin) / patience + skipped);
  }
  return code;
}

int timer_settime(timer_t timer, int flags, const struct itimerspec* next,
                  struct itimerspec* last) {
  const struct itimerspec later = {as_time(as_ns(next->it_interval) * patience),
                                   as_time(as_ns(next->it_value) * patience)};
  alarm_clock = timer;
  return real_settime(timer, flags, &later, last);
}

// The guest kernel's only way to wait, with its alarm set.
int sigsuspend(const sigset_t* mask) {
  struct itimerspec left;
  if (begin != 0 && timer_gettime(alarm_clock, &left) == 0) {
    skipped += as_ns(left.it_value) / patience + 1;
    left.it_value = as_time(1);
    real_settime(alarm_clock, 0, &left, NULL);
  }
  return real_suspend(mask);
}
