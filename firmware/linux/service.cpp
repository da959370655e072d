#include "linux/service.hpp"

#include <poll.h>
#include <sys/signalfd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <initializer_list>
#include <utility>

#include "linux/complaint.hpp"
#include "linux/fault_words.hpp"
#include "linux/statistics_file.hpp"
#include "linux/whole_file.hpp"
#include "node/reply.hpp"

namespace flexcomp {
namespace {

sigset_t set_of(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) {
    sigaddset(&set, signal);
  }
  return set;
}

sigset_t served_signals() { return set_of({SIGTERM, SIGINT, SIGHUP, SIGUSR1}); }

std::shared_ptr<const std::vector<char>> copy_of(const TableReceived& received) {
  const auto* bytes = static_cast<const char*>(received.data);
  return std::make_shared<const std::vector<char>>(bytes, bytes + received.size);
}

}  // namespace

Service::Service(const Options& options, Reread reread, std::optional<TableAdmission> signed_tables,
                 std::uint32_t counter, Exchange* exchange, Background* background)
    : options_(options),
      reread_(std::move(reread)),
      exchange_(exchange),
      background_(background),
      configurations_(std::make_shared<Channel<std::optional<NodeConfig>>>()),
      signed_tables_(signed_tables),
      counter_in_use_(counter) {
  if (!options.state_directory.empty()) {
    slots_ = std::make_shared<SlotFiles>(options.state_directory);
  }
  const sigset_t set = served_signals();
  signals_ = FileDescriptor(signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC));
  if (!options.lcm.empty()) {
    lcm_.emplace(options.lcm, [this](const LcmMessage& message) {
      exchange_->lcm_received.send({message.message, static_cast<std::uint32_t>(message.sequence)});
    });
  }
}

void Service::hold_requests() {
  const sigset_t set = set_of({SIGHUP, SIGUSR1});
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

void Service::block_signals() {
  const sigset_t set = served_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

bool Service::run() {
  try {
    while (!exchange_->has_ended()) {
      wait_and_serve();
    }
    on_real_time();  // what was sent before the end
    return true;
  } catch (const std::exception& error) {
    exchange_->stop();
    say_at_once("flexcompd: internal fault: ");
    say_at_once(error.what());
    say_at_once("\n");
    wait_for_end();
    return false;
  }
}

/// Needs nothing that can fail.
void Service::wait_for_end() {
  while (!exchange_->has_ended()) {
    pollfd input = {exchange_->from_real_time.number(), POLLIN, 0};
    poll(&input, 1, -1);
    exchange_->from_real_time.clear();
  }
}

void Service::wait_and_serve() {
  std::array<pollfd, 5> inputs = {{{signals_.number(), POLLIN, 0},
                                   {exchange_->from_real_time.number(), POLLIN, 0},
                                   {exchange_->lcm_to_send.number(), POLLIN, 0},
                                   {configurations_->number(), POLLIN, 0},
                                   {lcm_ ? lcm_->number() : -1, POLLIN, 0}}};
  poll(inputs.data(), inputs.size(), -1);
  if (inputs[0].revents != 0) {
    on_signals();
  }
  if (inputs[1].revents != 0) {
    on_real_time();
  }
  if (inputs[2].revents != 0) {
    exchange_->lcm_to_send.clear();
    Message message;
    while (exchange_->lcm_to_send.receive(&message)) {
      lcm_->publish(message);
    }
  }
  if (inputs[3].revents != 0) {
    on_configuration();
  }
  if (inputs[4].revents != 0) {
    lcm_->handle();
  }
}

void Service::on_signals() {
  signalfd_siginfo info{};
  while (read(signals_.number(), &info, sizeof info) == sizeof info) {
    if (info.ssi_signo == SIGUSR1) {
      const ToRealTime request = SnapshotRequest{};
      awaits_snapshot_ = awaits_snapshot_ || exchange_->to_real_time.send(request);
    } else if (info.ssi_signo == SIGHUP) {
      read_configuration();
    } else {
      exchange_->stop();
    }
  }
}

void Service::on_real_time() {
  exchange_->from_real_time.clear();
  FromRealTime item;
  while (exchange_->from_real_time.receive(&item)) {
    if (const auto* received = std::get_if<TableReceived>(&item)) {
      check(*received);
    } else if (const auto* in_use = std::get_if<TableInUse>(&item)) {
      keep(*in_use);
    } else if (const auto* has_run = std::get_if<TableHasRun>(&item)) {
      confirm(*has_run);
    } else if (const auto* latched = std::get_if<FaultsLatched>(&item)) {
      tell(*latched);
    } else if (const auto* config = std::get_if<ConfigResult>(&item)) {
      reads_configuration_ = false;
      background_->say(std::string("new configuration: ") + describe(config->result));
    } else if (const auto* snapshot = std::get_if<Snapshot>(&item)) {
      awaits_snapshot_ = false;
      report(*snapshot);
    }
  }
}

/// In the words of `flexcomp node status`.
void Service::tell(const FaultsLatched& latched) {
  const std::string words = fault_words(latched.faults, latched.node_faults);
  if (!words.empty()) {
    background_->say("latched: " + words);
  }
}

void Service::read_configuration() {
  if (reads_configuration_) {
    background_->say("a new configuration is being read already");
    return;
  }
  reads_configuration_ =
      background_->start([reread = reread_, result = configurations_, running = options_] {
        std::optional<Options> options;
        try {
          options = reread();
          const std::string refused = options ? refused_changes(running, *options) : "";
          if (!refused.empty()) {
            complain("new configuration refused: " + refused);
            options.reset();
          }
        } catch (const std::exception& error) {
          complain(std::string("the configuration cannot be read: ") + error.what());
        }
        result->send(options ? std::optional(options->settings.node) : std::nullopt);
      });
}

void Service::on_configuration() {
  configurations_->clear();
  std::optional<NodeConfig> config;
  while (configurations_->receive(&config)) {
    reads_configuration_ = config && exchange_->to_real_time.send(*config);
  }
}

void Service::check(const TableReceived& received) {
  received_ = nullptr;
  received_transfer_ = received.transfer;
  Verdict verdict;
  try {
    verdict = judge(received);
    if (verdict.refused == Reply::ok && verdict.opened == Result::ok && slots_ != nullptr) {
      received_ = copy_of(received);
    }
  } catch (const std::exception&) {  // no memory: the table in use stays
    verdict.refused = Reply::transfer_not_checked;
  }
  verdict.transfer = received.transfer;
  exchange_->to_real_time.send(verdict);
  background_->say("table of " + std::to_string(received.size) + " bytes received: " +
                   (verdict.refused != Reply::ok
                        ? describe_reply(static_cast<std::uint8_t>(verdict.refused))
                        : describe(verdict.opened)));
}

Verdict Service::judge(const TableReceived& received) {
  Verdict verdict;
  if (signed_tables_) {
    verdict.refused = signed_tables_->judge(received.data, received.size, &received_counter_);
  }
  if (verdict.refused == Reply::ok) {
    verdict.opened =
        Table::open(received.data, bytes_of_table(received.data, received.size), &verdict.table);
  }
  if (verdict.opened == Result::ok) {
    received.index.index(&verdict.table);
  }
  return verdict;
}

/// With a key a table is on trial until it has run.
void Service::keep(const TableInUse& in_use) {
  if (in_use.transfer != received_transfer_) {
    return;
  }
  counter_in_use_ = received_counter_;
  const auto table = std::exchange(received_, nullptr);
  if (slots_ == nullptr || table == nullptr) {
    return;
  }
  const bool on_trial = signed_tables_.has_value();
  const bool started = background_->start([slots = slots_, table, on_trial] {
    try {
      slots->stage(table->data(), table->size());
      if (!on_trial) {
        slots->confirm();
      }
    } catch (const std::exception& error) {
      complain(std::string("the table is in use but not kept: ") + error.what());
    }
  });
  if (!started) {
    background_->say("the table is in use but not kept: the disk is too slow");
  }
}

/// The counter is raised last: should the power go before, the same table starts again. It is not
/// raised where the table could not be kept: there would be none left to start with.
void Service::confirm(const TableHasRun& has_run) {
  if (!signed_tables_) {
    return;
  }
  signed_tables_->has_run(counter_in_use_);
  if (slots_ == nullptr) {
    return;
  }
  const bool was_there = has_run.transfer == 0;
  background_->start([slots = slots_, counter = counter_in_use_, was_there] {
    if (slots->confirm() || was_there) {
      slots->raise_counter(counter);
      complain("has run with table version " + std::to_string(counter));
    }
  });
}

void Service::report(const Snapshot& snapshot) {
  background_->start([snapshot, path = options_.statistics] {
    std::fputs(statistics_summary(snapshot).c_str(), stderr);
    if (!path.empty()) {
      const std::string text = statistics_json(snapshot);
      write_whole(path, text.data(), text.size());
    }
  });
}

}  // namespace flexcomp
