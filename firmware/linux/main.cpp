#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>

#include "linux/background.hpp"
#include "linux/clock.hpp"
#include "linux/complaint.hpp"
#include "linux/key_file.hpp"
#include "linux/options.hpp"
#include "linux/real_time_loop.hpp"
#include "linux/real_time_thread.hpp"
#include "linux/service.hpp"
#include "linux/unprivileged_user.hpp"
#include "linux/whole_file.hpp"
#include "node/reply.hpp"

namespace flexcomp {
namespace {

constexpr int kDone = 0;
constexpr int kUnusableInput = 2;
constexpr int kInternalFault = 3;

/// Memory for a table and its index, allocated once.
class Slot {
 public:
  explicit Slot(std::size_t bytes) : table_(bytes / 4), index_(bytes / kShare / 4) {}
  TableSlot memory() { return {table_.data(), table_.size(), {index_.data(), index_.size()}}; }

 private:
  static constexpr std::size_t kShare = 12;  // of the smallest record an index takes a fifteenth

  std::vector<std::uint32_t> table_;
  std::vector<std::uint32_t> index_;
};

struct Slots {
  explicit Slots(std::size_t bytes) : first(bytes), second(bytes) {}
  Slot first;
  Slot second;
};

struct InitialTable {
  std::string file;  ///< or directory
  std::vector<char> bytes;
  std::uint32_t counter = 0;  ///< with a key
};

/// The table that was last in use before; with a key only one that has run and may run still.
std::optional<InitialTable> kept_table(const Options& options, const TableAdmission* admission) {
  const SlotFiles slots(options.state_directory);
  std::optional<std::vector<char>> bytes = admission == nullptr
                                               ? slots.newest(options.table_capacity)
                                               : slots.confirmed(options.table_capacity);
  if (!bytes) {
    return std::nullopt;
  }
  InitialTable table{options.state_directory, std::move(*bytes)};
  if (admission != nullptr) {
    const Reply reply = admission->judge(table.bytes.data(), table.bytes.size(), &table.counter);
    if (reply != Reply::ok) {
      complain(options.state_directory +
               ": not used: " + describe_reply(static_cast<std::uint8_t>(reply)));
      return std::nullopt;
    }
  }
  return table;
}

std::optional<InitialTable> initial_table(const Options& options, const TableAdmission* admission) {
  if (!options.state_directory.empty()) {
    if (std::optional<InitialTable> kept = kept_table(options, admission)) {
      return kept;
    }
  }
  if (options.table.empty()) {
    return std::nullopt;
  }
  std::optional<std::vector<char>> bytes = read_whole(options.table, options.table_capacity);
  if (!bytes) {
    throw std::runtime_error(options.table + ": there is no such file");
  }
  InitialTable table{options.table, std::move(*bytes)};
  if (admission != nullptr) {
    const Reply reply = admission->judge(table.bytes.data(), table.bytes.size(), &table.counter);
    if (reply != Reply::ok) {
      throw std::runtime_error(options.table + ": " +
                               describe_reply(static_cast<std::uint8_t>(reply)));
    }
  }
  return table;
}

/// With a key: which tables are taken, after those that have run.
std::optional<TableAdmission> admission_of_tables(const Options& options) {
  if (options.key.empty()) {
    return std::nullopt;
  }
  const std::uint32_t highest =
      options.state_directory.empty() ? 0 : SlotFiles(options.state_directory).counter();
  return TableAdmission(read_key(options.key), highest);
}

/// Puts the first table into slot 0. A damaged one ends the program; one that is refused for
/// another reason is reported over the bus when somebody wants to arm.
void load_table(const Options& options, const InitialTable& initial, TableSlot slot, Node* node) {
  std::memcpy(slot.words, initial.bytes.data(), initial.bytes.size());
  Table table;
  const Result opened =
      Table::open(slot.words, bytes_of_table(slot.words, initial.bytes.size()), &table);
  if (opened != Result::ok) {
    throw std::runtime_error(initial.file + ": " + describe(opened));
  }
  slot.index.index(&table);
  if (!options.key.empty()) {
    complain(fmt::format("starts with table version {} of {}", initial.counter, initial.file));
  }
  const Result used = node->start_with(0, table);
  if (used == Result::gain_too_high) {
    complain(fmt::format("refuses to arm: gain {:.4g} is above the largest safe gain {:.4g}",
                         options.settings.node.compensator.gain, table.header().largest_gain));
  } else if (used != Result::ok) {
    complain(std::string("refuses to arm: ") + describe(used));
  }
}

/// The settings as a microcontroller has them in its flash, its key for tables among them.
int write_settings(const Options& options) {
  if (!is_usable(options.settings.node)) {
    throw std::runtime_error(describe(Result::bad_config));
  }
  NodeSettings settings = options.settings;
  if (!options.key.empty()) {
    settings.table_key = read_key(options.key);
    complain(options.settings_out +
             ": holds the key, for tables; the microcontroller's messages are not authenticated");
  }
  const SettingsRecord record = to_record(settings);
  write_whole(options.settings_out, &record, sizeof record,
              settings.table_key ? Readers::owner : Readers::all);
  return kDone;
}

/// Whatever happens, the real-time thread is told to fade and end before it is waited for.
struct StopAtEnd {
  explicit StopAtEnd(Exchange* shared) : exchange(shared) {}
  StopAtEnd(const StopAtEnd&) = delete;
  StopAtEnd& operator=(const StopAtEnd&) = delete;
  ~StopAtEnd() { exchange->stop(); }
  Exchange* exchange;
};

/// Ends the process when the last files are written, or, where the disk stalls, without them.
int end(Background* background, int exit_code) {
  constexpr std::chrono::milliseconds kPatience{2000};
  if (!background->finish(kPatience)) {
    say_at_once("flexcompd: ends with files not written: they take too long\n");
    std::_Exit(exit_code);
  }
  return exit_code;
}

/// Nothing without an address for it.
std::unique_ptr<RsiTransport> open_rsi(const Options& options) {
  if (options.rsi.address.empty()) {
    return nullptr;
  }
  return std::make_unique<RsiTransport>(to_config(options.rsi, options.settings.tolerated_losses),
                                        UdpSocket(options.rsi.address));
}

/// Nothing without an address for it.
std::unique_ptr<RdtTransport> open_sensor(const SensorOptions& options) {
  return options.address.empty()
             ? nullptr
             : std::make_unique<RdtTransport>(to_config(options), options.address);
}

/// Prepares and serves. A signal to end does so at once until it is blocked: nothing is corrected
/// yet. From then on nothing here may wait but for the next thing to do.
int serve(const Options& options, Service::Reread reread) {
  Service::hold_requests();
  std::optional<UnprivilegedUser> user;
  if (!options.user.empty()) {
    user.emplace(options.user);
  }
  auto node = std::make_unique<Node>();
  Slots slots(options.table_capacity);
  node->use_memory(slots.first.memory(), slots.second.memory());
  if (node->configure(options.settings.node) != Result::ok) {
    throw std::runtime_error(describe(Result::bad_config));
  }
  std::unique_ptr<MessageAuthentication> authentication;
  if (!options.key.empty()) {
    authentication = std::make_unique<MessageAuthentication>(read_key(options.key), freshness_now);
  }
  std::optional<TableAdmission> admission = admission_of_tables(options);
  const std::optional<InitialTable> table =
      initial_table(options, admission ? &*admission : nullptr);
  CanSocket can = options.can.empty() ? CanSocket() : CanSocket(options.can, options.fd);
  std::unique_ptr<RsiTransport> rsi = open_rsi(options);
  std::unique_ptr<RdtTransport> sensor = open_sensor(options.sensor);
  if (table) {
    load_table(options, *table, slots.first.memory(), node.get());
  } else {
    complain("no table yet; waiting for one over the bus");
  }

  Service::block_signals();
  Background background;
  auto exchange = std::make_unique<Exchange>();
  Service service(options, std::move(reread), admission, table ? table->counter : 0, exchange.get(),
                  &background);
  RealTimeLoop loop(options, node.get(), &can, authentication.get(), rsi.get(), sensor.get(),
                    exchange.get());
  const RealTimeThread thread(options.priority, [&] { loop.run(); });
  const StopAtEnd stop_at_end(exchange.get());
  int exit_code = kDone;
  if (user && !user->become()) {
    background.say("the system does not let it become '" + options.user + "'");
    exchange->stop();
    exit_code = kInternalFault;
  }
  if (!service.run()) {
    exit_code = kInternalFault;
  }
  return end(&background, exit_code);
}

}  // namespace
}  // namespace flexcomp

int main(int argc, char** argv) {
  try {
    int exit_code = flexcomp::kDone;
    const auto options = flexcomp::read_options(argc, argv, &exit_code);
    if (!options) {
      return exit_code;
    }
    if (!options->settings_out.empty()) {
      return flexcomp::write_settings(*options);
    }
    return flexcomp::serve(*options, [=] {
      int ignored = 0;
      return flexcomp::read_options(argc, argv, &ignored);
    });
  } catch (const std::runtime_error& error) {
    flexcomp::complain(error.what());
    return flexcomp::kUnusableInput;
  } catch (const std::exception& error) {
    flexcomp::complain(std::string("internal fault: ") + error.what());
    return flexcomp::kInternalFault;
  }
}
