#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "cli/node_bus.hpp"
#include "cli/number_options.hpp"
#include "cli/progress.hpp"
#include "cli/table_file.hpp"
#include "core/crc32.hpp"
#include "error.hpp"
#include "linux/clock.hpp"
#include "node/reply.hpp"

namespace flexcomp::cli {
namespace {

constexpr std::int64_t kPatience = 1'000'000'000;  // ns, for an answer
/// The node forgets a sender's count of frames 50 ms after the last (messages/sequence.cpp).
constexpr auto kForgets = std::chrono::milliseconds(60);

struct NodeOptions {
  NodeAddress address;
  std::string table;
  double pause = 100e-6;
};

/// The bus, when the node has forgotten the last command's process: it counted its frames from zero
/// as this one does, so that ours would pass for repetitions.
std::unique_ptr<simulation::PlantBus> open_as_new_sender(const NodeAddress& address) {
  auto bus = address.open();
  std::this_thread::sleep_for(kForgets);
  return bus;
}

/// The next message of a kind; throws if none comes in time, however many others do.
template <typename Kind>
Kind wait_for(simulation::PlantBus* bus, const std::string& address) {
  const std::int64_t until = monotonic_now() + kPatience;
  Message message;
  for (std::int64_t left = kPatience; left > 0 && bus->receive(&message, left);
       left = until - monotonic_now()) {
    if (const auto* found = std::get_if<Kind>(&message)) {
      return *found;
    }
  }
  throw InputError(address + ": nobody answers");
}

int command(const NodeOptions& options, Command wanted) {
  const auto bus = open_as_new_sender(options.address);
  bus->send(CommandMessage{wanted});
  CommandReplyMessage reply = wait_for<CommandReplyMessage>(bus.get(), options.address.bus);
  while (reply.command != wanted) {
    reply = wait_for<CommandReplyMessage>(bus.get(), options.address.bus);
  }
  if (reply.reply == static_cast<std::uint8_t>(Result::gain_too_high)) {
    fmt::print("{}; the largest safe one is {:.4g}\n", describe_reply(reply.reply),
               reply.largest_gain);
  } else {
    fmt::print("{}\n", describe_reply(reply.reply));
  }
  return reply.reply == 0 ? kDone : kDoesNotHold;
}

int send_table(const NodeOptions& options) {
  // With its signature, if it has one.
  const std::vector<std::uint32_t> words = read_any_table(options.table).words;
  const auto size = static_cast<std::uint32_t>(words.size() * sizeof(std::uint32_t));
  const auto bus = open_as_new_sender(options.address);
  const std::uint32_t crc = crc32(words.data(), size);
  bus->send(TransferBeginMessage{size, crc});
  TransferReplyMessage reply = wait_for<TransferReplyMessage>(bus.get(), options.address.bus);
  if (reply.result != 0) {
    fmt::print("{}\n", describe_reply(reply.result));
    return kDoesNotHold;
  }
  const bool wide = options.address.bus.rfind("can:", 0) != 0;
  const std::size_t at_once = wide ? TransferDataMessage::kMaxWords : 1;
  Progress progress("sending", words.size());
  for (std::size_t i = 0; i < words.size(); i += at_once) {
    TransferDataMessage data{static_cast<std::uint32_t>(i), 0, {}};
    data.count = static_cast<std::uint32_t>(std::min(at_once, words.size() - i));
    std::copy_n(words.begin() + static_cast<std::ptrdiff_t>(i), data.count, data.words.begin());
    bus->send(data);
    progress.show(i);
    std::this_thread::sleep_for(std::chrono::duration<double>(options.pause));
  }
  bus->send(TransferEndMessage{crc});
  reply = wait_for<TransferReplyMessage>(bus.get(), options.address.bus);
  fmt::print("{}\n", describe_reply(reply.result));
  return reply.result == 0 ? kDone : kDoesNotHold;
}

}  // namespace

void add_bus(CLI::App* command, NodeAddress* address) {
  command->add_option("--bus", address->bus, "can:INTERFACE, canfd:INTERFACE or lcm:URL")
      ->required();
  command->add_option("--key", address->key,
                      "file with the key of flexcompd --key, 32 hexadecimal digits (CAN only)");
}

void add_node(CLI::App* app, Action* action) {
  auto options = std::make_shared<NodeOptions>();
  CLI::App* node = app->add_subcommand(
      "node",
      "Tell a compensator on the bus what to do, or look how it is. Exit code 1 if it refuses,\n"
      "with the reason.\n"
      "Example: flexcomp node arm --bus can:can0\n"
      "         flexcomp node send-table t.fct --bus can:can0\n"
      "         flexcomp node monitor --bus can:can0");
  node->require_subcommand(1);
  const std::array<std::tuple<const char*, Command, const char*>, 3> commands = {{
      {"arm", Command::arm, "Start to correct; the sender of setpoints must have named its robot."},
      {"disarm", Command::disarm, "Fade out, then off."},
      {"reset", Command::reset, "Forget the faults that latched it."},
  }};
  for (const auto& [name, wanted, help] : commands) {
    CLI::App* one = node->add_subcommand(name, help);
    add_bus(one, &options->address);
    one->callback([=, wanted = wanted] { *action = [=] { return command(*options, wanted); }; });
  }
  CLI::App* send = node->add_subcommand(
      "send-table", "Send a table, which is verified there and swapped in between two ticks.");
  send->add_option("table", options->table, "made by flexcomp table")->required();
  add_bus(send, &options->address);
  send->add_option("--pause", options->pause, "s, between messages, which leaves room on the bus")
      ->check(zero_or_above());
  send->callback([=] { *action = [=] { return send_table(*options); }; });
  add_node_views(node, action);
}

}  // namespace flexcomp::cli
