#include "linux/service.hpp"

#include <poll.h>
#include <sys/signalfd.h>

#include <csignal>
#include <cstdio>
#include <exception>

#include "linux/statistics_file.hpp"
#include "linux/whole_file.hpp"

namespace flexcomp {
namespace {

sigset_t served_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGUSR1}) {
    sigaddset(&set, signal);
  }
  return set;
}

}  // namespace

Service::Service(const Options& options, std::function<std::optional<Options>()> reread,
                 Channel<ToRealTime>* to_real_time, Channel<FromRealTime>* from_real_time)
    : options_(options),
      reread_(std::move(reread)),
      to_real_time_(to_real_time),
      from_real_time_(from_real_time) {
  const sigset_t set = served_signals();
  signals_ = FileDescriptor(signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC));
  if (!options.lcm.empty()) {
    lcm_.emplace(options.lcm, [this](const LcmMessage& message) {
      to_real_time_->send(LcmSample{message.message, static_cast<std::uint32_t>(message.sequence)});
    });
  }
}

void Service::block_signals() {
  const sigset_t set = served_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

void Service::run() {
  while (!ended_) {
    std::array<pollfd, 3> inputs = {{{signals_.number(), POLLIN, 0},
                                     {from_real_time_->number(), POLLIN, 0},
                                     {lcm_ ? lcm_->number() : -1, POLLIN, 0}}};
    poll(inputs.data(), inputs.size(), -1);
    if (inputs[0].revents != 0) {
      on_signal();
    }
    if (inputs[1].revents != 0) {
      on_real_time();
    }
    if (inputs[2].revents != 0) {
      lcm_->handle();
    }
  }
}

void Service::on_signal() {
  signalfd_siginfo info{};
  while (read(signals_.number(), &info, sizeof info) == sizeof info) {
    if (info.ssi_signo == SIGUSR1) {
      to_real_time_->send(SnapshotRequest{});
    } else if (info.ssi_signo == SIGHUP) {
      if (const std::optional<Options> options = reread_()) {
        to_real_time_->send(options->settings.node);
      }
    } else {
      to_real_time_->send(Stop{});
    }
  }
}

void Service::on_real_time() {
  from_real_time_->clear();
  FromRealTime item;
  while (from_real_time_->receive(&item)) {
    if (const auto* message = std::get_if<Message>(&item)) {
      lcm_->publish(*message);
    } else if (const auto* received = std::get_if<TableReceived>(&item)) {
      check(*received);
    } else if (std::holds_alternative<TableInUse>(item)) {
      keep();
    } else if (const auto* config = std::get_if<ConfigResult>(&item)) {
      std::fprintf(stderr, "flexcompd: new configuration: %s\n", describe(config->result));
    } else if (const auto* snapshot = std::get_if<Snapshot>(&item)) {
      report(*snapshot);
    } else if (std::holds_alternative<Ended>(item)) {
      ended_ = true;
    }
  }
}

void Service::check(const TableReceived& received) {
  received_ = received;
  Verdict verdict;
  verdict.opened = Table::open(received.data, received.size, &verdict.table);
  std::fprintf(stderr, "flexcompd: table of %zu bytes received: %s\n", received.size,
               describe(verdict.opened));
  to_real_time_->send(verdict);
}

void Service::keep() const {
  if (options_.state_directory.empty()) {
    return;
  }
  try {
    SlotFiles(options_.state_directory).keep(received_.data, received_.size);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "flexcompd: the table is in use but not kept: %s\n", error.what());
  }
}

void Service::report(const Snapshot& snapshot) const {
  std::fputs(statistics_summary(snapshot).c_str(), stderr);
  if (options_.statistics.empty()) {
    return;
  }
  const std::string text = statistics_json(snapshot);
  try {
    write_whole(options_.statistics, text.data(), text.size());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "flexcompd: %s\n", error.what());
  }
}

}  // namespace flexcomp
