// Telegram in, answer out: how long it takes over UDP, beside a process that does nothing but send
// the datagram back. Both are measured in turns in one run, by this one client, which plays a
// controller that stands in the cut.
//
//   bench_rsi_latency ADDRESS SECONDS A1 A2 A3 A4 A5 A6
//
// ADDRESS: udp://ADDRESS:PORT of a flexcompd with the elements of `flexcomp configure --rsi
// --rsi-force`. A1 to A6: degrees, a point of its table's program. Prints medians and 99.9th
// percentiles in µs, answers later than the cycle of 4 ms, and the node's state at the end.
#include <poll.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "linux/clock.hpp"
#include "linux/udp_socket.hpp"

using namespace flexcomp;

namespace {

constexpr std::int64_t kCycle = 4'000'000;  // ns
constexpr const char* kEcho = "udp://127.0.0.1:49199";

bool wait_for(const UdpSocket& socket, std::int64_t patience) {
  pollfd input{socket.number(), POLLIN, 0};
  timespec time{0, static_cast<long>(std::max<std::int64_t>(patience, 0))};
  return ppoll(&input, 1, &time, nullptr) > 0;
}

[[noreturn]] void echo() {
  sched_param parameters{};
  parameters.sched_priority = 80;
  sched_setscheduler(0, SCHED_FIFO, &parameters);
  UdpSocket socket(kEcho);
  std::array<char, 4096> data{};
  while (true) {
    pollfd input{socket.number(), POLLIN, 0};
    poll(&input, 1, -1);
    sockaddr_in from{};
    const long size = socket.receive(data.data(), data.size(), &from);
    if (size > 0) {
      socket.send({data.data(), static_cast<std::size_t>(size)}, from);
    }
  }
}

struct Peer {
  UdpSocket socket;
  std::vector<double> latency;  // µs
  std::uint64_t late = 0;
  std::string last;

  /// Sends a telegram and waits for the answer with its IPOC.
  void ask(const std::string& telegram, const std::string& ipoc) {
    const std::int64_t start = monotonic_now();
    socket.send(telegram);
    while (true) {
      std::array<char, 4096> data{};
      sockaddr_in from{};
      const long size = socket.receive(data.data(), data.size(), &from);
      const std::int64_t elapsed = monotonic_now() - start;
      if (size > 0) {
        last.assign(data.data(), static_cast<std::size_t>(size));
        if (last.find(ipoc) != std::string::npos) {
          latency.push_back(static_cast<double>(elapsed) / 1e3);
          late += elapsed > kCycle ? 1U : 0U;
          return;
        }
      } else if (elapsed > kCycle) {
        ++late;
        return;
      } else {
        wait_for(socket, kCycle - elapsed + 1000);
      }
    }
  }

  double quantile(double share) {
    std::sort(latency.begin(), latency.end());
    return latency.empty()
               ? 0
               : latency[static_cast<std::size_t>(share * static_cast<double>(latency.size() - 1))];
  }
};

std::string telegram(const char* const* angles, std::uint64_t cycle, std::uint64_t late,
                     const std::string& ipoc) {
  std::string axes;
  std::string nothing;
  for (int i = 0; i < 6; ++i) {
    axes += " A" + std::to_string(i + 1) + "=\"" + angles[i] + "\"";
    nothing += " A" + std::to_string(i + 1) + "=\"0.0000\"";
  }
  const std::string noise = "." + std::to_string(cycle * 7919 % 10'000);
  return "<Rob Type=\"KUKA\"><AIPos" + axes + "/><ASPos" + axes + "/><Delay D=\"" +
         std::to_string(late) + "\"/><Arm>" + (cycle > 100 ? "1" : "0") + "</Arm><AxisCorrMon" +
         nothing + "/><FT Fx=\"440" + noise + "\" Fy=\"1370" + noise + "\" Fz=\"635" + noise +
         "\" Mx=\"0.0000\" My=\"3.0000\" Mz=\"10.5000\"/>" + ipoc + "</Rob>";
}

void sleep_until(std::int64_t time) {
  const timespec at{time / 1'000'000'000, time % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

void print(const char* name, Peer* peer) {
  std::printf("%s: median %.1f us, 99.9 %% %.1f us, %llu of %zu later than 4 ms\n", name,
              peer->quantile(0.5), peer->quantile(0.999),
              static_cast<unsigned long long>(peer->late), peer->latency.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 9) {
    std::fprintf(stderr, "usage: bench_rsi_latency ADDRESS SECONDS A1 A2 A3 A4 A5 A6\n");
    return 2;
  }
  const pid_t child = fork();
  if (child == 0) {
    echo();
  }
  sleep_until(monotonic_now() + 200'000'000);
  Peer bare{UdpSocket::to(kEcho), {}, 0, {}};
  Peer node{UdpSocket::to(argv[1]), {}, 0, {}};
  const auto cycles = static_cast<std::uint64_t>(std::strtod(argv[2], nullptr) * 1e9 / kCycle);
  std::int64_t next = monotonic_now();
  for (std::uint64_t cycle = 1; cycle <= cycles; ++cycle) {
    const std::string ipoc = "<IPOC>" + std::to_string(4 * cycle) + "</IPOC>";
    const std::string text = telegram(argv + 3, cycle, node.late, ipoc);
    Peer* const first = cycle % 2 == 0 ? &bare : &node;
    Peer* const second = cycle % 2 == 0 ? &node : &bare;
    first->ask(text, ipoc);
    second->ask(text, ipoc);
    next = std::max(next + kCycle, monotonic_now());
    sleep_until(next);
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  print("echo", &bare);
  print("flexcompd", &node);
  std::printf("ratio of the medians %.3f\nlast answer %s\n",
              node.quantile(0.5) / bare.quantile(0.5), node.last.c_str());
  return 0;
}
