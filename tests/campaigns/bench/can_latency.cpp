// Setpoint in, corrected setpoint out: how long it takes on a CAN interface, beside a process that
// does nothing but send the setpoint back. Both are measured in turns in one run, by this one
// client.
//
//   bench_can_latency INTERFACE FLEXCOMPD CONFIG [COUNT]
//
// Prints the medians and the 99.9th percentiles in µs, and their ratios, for classic CAN (three
// frames there and back) and CAN FD (one).
#include <poll.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "linux/can_socket.hpp"
#include "linux/clock.hpp"
#include "messages/can_encoder.hpp"
#include "messages/e2e.hpp"

using namespace flexcomp;

namespace {

constexpr std::int64_t kPeriod = 4'000'000;  // ns
constexpr std::uint32_t kSetpoint = 0x100;
constexpr std::uint32_t kSetpointFd = 0x108;
constexpr std::uint32_t kAnswer = 0x100;  // from a setpoint's identifier to that of its answer

void wait_for(const CanSocket& socket, int milliseconds) {
  pollfd input{socket.number(), POLLIN, 0};
  poll(&input, 1, milliseconds);
}

bool is_setpoint(const CanFrame& frame) {
  return (frame.id >= kSetpoint && frame.id <= kSetpoint + 2) || frame.id == kSetpointFd;
}

/// Sends every setpoint frame back under the identifier of its answer, once the set is complete.
[[noreturn]] void echo(const std::string& interface) {
  sched_param parameters{};
  parameters.sched_priority = 80;
  sched_setscheduler(0, SCHED_FIFO, &parameters);
  CanSocket socket(interface, true);
  std::vector<CanFrame> set;
  while (true) {
    CanFrame frame;
    if (socket.receive(&frame) != CanSocket::Received::frame) {
      wait_for(socket, -1);
      continue;
    }
    if (!is_setpoint(frame)) {
      continue;
    }
    set.push_back(frame);
    if (frame.id == kSetpoint + 2 || frame.fd) {
      for (CanFrame& answer : set) {
        answer.id += kAnswer;
        socket.send(answer);
      }
      set.clear();
    }
  }
}

pid_t start_echo(const std::string& interface) {
  const pid_t child = fork();
  if (child == 0) {
    echo(interface);
  }
  return child;
}

pid_t start_flexcompd(const std::string& program, const std::string& config,
                      const std::string& interface, bool fd) {
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stderr);
    execl(program.c_str(), program.c_str(), "--config", config.c_str(), "--can", interface.c_str(),
          fd ? "--fd" : nullptr, nullptr);
    _exit(127);
  }
  return child;
}

void stop(pid_t child, int signal) {
  kill(child, signal);
  waitpid(child, nullptr, 0);
}

/// Sends setpoints a period apart; how long each answer took, µs.
std::vector<double> measure(const std::string& interface, bool fd, int count) {
  CanSocket socket(interface, true);
  CanEncoder encoder(fd);
  const std::uint32_t last = (fd ? kSetpointFd : kSetpoint + 2) + kAnswer;
  std::vector<double> times;
  std::int64_t next = monotonic_now();
  for (int i = 0; i < count; ++i) {
    next += kPeriod;
    const auto pause =
        static_cast<useconds_t>(std::max<std::int64_t>(0, next - monotonic_now()) / 1000);
    usleep(pause);
    CanFrame frame;
    while (socket.receive(&frame) == CanSocket::Received::frame) {
    }
    const FrameList frames =
        encoder.encode(SetpointMessage{monotonic_now(), {0.1, -1, 1.5, 0, 1, 0}});
    const std::int64_t sent = monotonic_now();
    for (std::size_t k = 0; k < frames.count; ++k) {
      socket.send(frames.frames[k]);
    }
    const std::int64_t until = sent + kPeriod;
    while (monotonic_now() < until) {
      if (socket.receive(&frame) != CanSocket::Received::frame) {
        wait_for(socket, 4);
      } else if (frame.id == last) {
        times.push_back(static_cast<double>(monotonic_now() - sent) / 1000);
        break;
      }
    }
  }
  return times;
}

double quantile(std::vector<double> times, double share) {
  if (times.empty()) {
    return 0;
  }
  std::sort(times.begin(), times.end());
  return times[std::min(times.size() - 1,
                        static_cast<std::size_t>(share * static_cast<double>(times.size())))];
}

void append(std::vector<double>* all, const std::vector<double>& more) {
  all->insert(all->end(), more.begin(), more.end());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: bench_can_latency INTERFACE FLEXCOMPD CONFIG [COUNT]\n");
    return 2;
  }
  const std::string interface = argv[1];
  const int count = argc > 4 ? std::atoi(argv[4]) : 3000;
  constexpr int kTurns = 5;
  for (const bool fd : {false, true}) {
    std::vector<double> bare;
    std::vector<double> node;
    for (int turn = 0; turn < kTurns; ++turn) {
      pid_t child = start_echo(interface);
      usleep(200'000);
      append(&bare, measure(interface, fd, count / kTurns));
      stop(child, SIGKILL);
      child = start_flexcompd(argv[2], argv[3], interface, fd);
      usleep(300'000);
      measure(interface, fd, 50);  // it finds the middle of its period
      append(&node, measure(interface, fd, count / kTurns));
      stop(child, SIGTERM);
    }
    std::printf("%-9s echo  %6.1f us median %7.1f us 99.9 %%  (%zu answers)\n",
                fd ? "CAN FD" : "CAN", quantile(bare, 0.5), quantile(bare, 0.999), bare.size());
    std::printf("%-9s node  %6.1f us median %7.1f us 99.9 %%  (%zu answers)  ratio %.2f, %.2f\n",
                fd ? "CAN FD" : "CAN", quantile(node, 0.5), quantile(node, 0.999), node.size(),
                quantile(node, 0.5) / quantile(bare, 0.5),
                quantile(node, 0.999) / quantile(bare, 0.999));
    std::fflush(stdout);
  }
  return 0;
}
