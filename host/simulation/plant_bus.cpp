#include "simulation/plant_bus.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>
#include <optional>
#include <thread>
#include <vector>

#include "error.hpp"
#include "linux/can_socket.hpp"
#include "linux/clock.hpp"
#include "linux/key_file.hpp"
#include "linux/lcm_link.hpp"
#include "messages/can_decoder.hpp"
#include "messages/can_encoder.hpp"
#include "messages/message_authentication.hpp"
#include "node/can_link.hpp"
#include "simulation/wait_for_input.hpp"

namespace flexcomp::simulation {
namespace {

class CanBus : public PlantBus {
 public:
  /// `key_file`: empty for messages without authentication.
  CanBus(const std::string& interface, bool fd, const std::string& key_file)
      : socket_(interface, fd), encoder_(fd) {
    if (!key_file.empty()) {
      authentication_.emplace(read_key(key_file), freshness_now);
    }
  }

  void send(const Message& message) override {
    const FrameList& list = encoder_.encode(message);
    if (authentication_) {
      const SealedFrames& sealed = authentication_->seal(list);
      socket_.send(sealed.frames.data(), sealed.count);
    } else {
      socket_.send(list.frames.data(), list.count);
    }
  }

  bool receive(Message* message, std::int64_t patience) override {
    const std::int64_t until = monotonic_now() + patience;
    while (true) {
      CanFrame frame;
      CanSocket::Received received = socket_.receive(&frame);
      while (received != CanSocket::Received::nothing) {
        *message = received == CanSocket::Received::frame ? decode(frame) : Message();
        if (message->index() != 0) {
          return true;
        }
        received = socket_.receive(&frame);
      }
      const std::int64_t left = until - monotonic_now();
      if (left <= 0 || !wait_for_input(socket_.number(), left)) {
        return false;
      }
    }
  }

  BusCounts counts() const override {
    BusCounts counts;
    for (std::size_t group = 0; group < kFrameGroups; ++group) {
      const StreamCounters& of = decoder_.monitor(static_cast<FrameGroup>(group)).counters;
      counts.lost += of.lost;
      counts.damaged += std::uint64_t{of.corrupt} + of.incomplete;
    }
    return counts;
  }

 private:
  /// The message that this frame completes, if it may be used.
  Message decode(const CanFrame& frame) {
    if (!authentication_) {
      return decoder_.decode(frame, monotonic_now());
    }
    Message message;
    const FrameList& admitted = authentication_->admit(frame);
    for (std::size_t i = 0; i < admitted.count; ++i) {
      message = decoder_.decode(admitted.frames[i], monotonic_now());  // only the last completes it
    }
    return message;
  }

  CanSocket socket_;
  std::optional<MessageAuthentication> authentication_;
  CanEncoder encoder_;
  CanDecoder decoder_;
};

class LcmBus : public PlantBus {
 public:
  explicit LcmBus(const std::string& url)
      : link_(url, [this](const LcmMessage& message) {
          monitors_[message.message.index()].accept(static_cast<std::uint32_t>(message.sequence), 0,
                                                    monotonic_now());
          received_.push_back(message.message);
        }) {
    monitors_.fill(SequenceMonitor(kLcmCounter));
  }

  void send(const Message& message) override { link_.publish(message); }

  bool receive(Message* message, std::int64_t patience) override {
    // A frame that arrives may be an echo of our own, which the link swallows.
    const std::int64_t until = monotonic_now() + patience;
    while (received_.empty()) {
      const std::int64_t left = std::max<std::int64_t>(0, until - monotonic_now());
      if (has_ended_) {
        std::this_thread::sleep_for(std::chrono::nanoseconds(left));
        return false;
      }
      if (!wait_for_input(link_.number(), left)) {
        return false;
      }
      has_ended_ = !link_.handle();
    }
    *message = received_.front();
    received_.pop_front();
    return true;
  }

  BusCounts counts() const override {
    BusCounts counts;
    for (const SequenceMonitor& monitor : monitors_) {
      counts.lost += monitor.counters.lost;
    }
    return counts;
  }

 private:
  static constexpr std::uint32_t kLcmCounter = 256;  // of the 64 bits, so many suffice to see gaps

  std::deque<Message> received_;
  std::array<SequenceMonitor, std::variant_size_v<Message>> monitors_;
  LcmLink link_;
  bool has_ended_ = false;  ///< a log that was played
};

class InnerBus : public PlantBus {
 public:
  InnerBus(const NodeConfig& config, const Table& table, bool fd)
      : period_(static_cast<std::int64_t>(1e9 * static_cast<double>(config.compensator.period))),
        link_(fd, 3),
        encoder_(fd) {
    NodeConfig in_steps = config;
    in_steps.use_timestamps = false;
    if (node_->configure(in_steps) != Result::ok) {
      throw InputError(describe(Result::bad_config));
    }
    const std::size_t size = table.header().size;
    slot_.resize(size / sizeof(std::uint32_t));
    std::memcpy(slot_.data(), &table.header(), size);
    node_->use_memory({slot_.data(), slot_.size()}, {});
    Table own;
    Table::open(slot_.data(), size, &own);
    index_.resize(path_index_size(own) / sizeof(std::uint32_t));
    index_path(index_.data(), path_index_size(own), &own);
    node_->start_with(0, own);
  }

  void send(const Message& message) override {
    const FrameList list = encoder_.encode(message);
    for (std::size_t i = 0; i < list.count; ++i) {
      if (link_.receive(list.frames[i], node_.get(), ticks_ * period_)) {
        tick();
      }
    }
  }

  bool receive(Message* message, std::int64_t /*patience*/) override {
    if (received_.empty()) {
      return false;
    }
    *message = received_.front();
    received_.pop_front();
    return true;
  }

 private:
  void tick() {
    ++ticks_;
    if (node_->take_reset()) {
      link_.forget_conflicts();
    }
    node_->set_link(link_.state());
    put(node_->tick(ticks_ * period_));
    Message message;
    while (node_->next_message(&message)) {
      put(message);
    }
  }

  void put(const Message& message) {
    const FrameList list = link_.encode(message);
    for (std::size_t i = 0; i < list.count; ++i) {
      const Message decoded = decoder_.decode(list.frames[i], ticks_ * period_);
      if (decoded.index() != 0) {
        received_.push_back(decoded);
      }
    }
  }

  std::int64_t period_;
  std::int64_t ticks_ = 0;
  std::unique_ptr<Node> node_ = std::make_unique<Node>();
  std::vector<std::uint32_t> slot_;
  std::vector<std::uint32_t> index_;
  CanLink link_;
  CanEncoder encoder_;
  CanDecoder decoder_;
  std::deque<Message> received_;
};

}  // namespace

std::unique_ptr<PlantBus> open_plant_bus(const std::string& address, const std::string& key_file) {
  const std::size_t colon = address.find(':');
  const std::string kind = address.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : address.substr(colon + 1);
  try {
    if ((kind == "can" || kind == "canfd") && !rest.empty()) {
      return std::make_unique<CanBus>(rest, kind == "canfd", key_file);
    }
    if (!key_file.empty()) {
      throw InputError("--key authenticates messages on CAN only, not on " + address);
    }
    if (kind == "lcm" && !rest.empty()) {
      return std::make_unique<LcmBus>(rest);
    }
  } catch (const std::runtime_error& error) {
    throw InputError(error.what());
  }
  throw InputError("--bus " + address + ": expected can:INTERFACE, canfd:INTERFACE or lcm:URL");
}

std::unique_ptr<PlantBus> make_inner_bus(const NodeConfig& config, const Table& table, bool fd) {
  return std::make_unique<InnerBus>(config, table, fd);
}

}  // namespace flexcomp::simulation
