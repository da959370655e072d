#pragma once

#include <string_view>

#include "force_sensor/mounting.hpp"
#include "force_sensor/rdt_record.hpp"
#include "messages/sequence.hpp"
#include "node/node.hpp"

namespace flexcomp {

struct RdtConfig {
  SensorMounting mounting;
  double counts_per_newton = 1e6;
  double counts_per_newton_metre = 1e6;
  std::array<double, 6> zero{};  ///< N, N·m: what the sensor shows with no load on it
};

/// A node's side of a sensor that streams records (RDT), whatever moves the datagrams. No
/// allocation, no I/O.
///
/// Rules:
/// - A tick uses the newest record that has come, at the angles of the newest setpoint. A node
///   without a setpoint gets no wrench.
/// - Nothing of a record counts whose status is not zero, or that is none, or older than the last:
///   the node holds, fades and latches as for a wrench that does not come.
/// - A sensor that is silent is asked to stream, twice a second: it may have been started anew.
class RdtLink {
 public:
  explicit RdtLink(const RdtConfig& config) : config_(config) {}

  /// Takes a datagram of the sensor; `now` (ns) only grows.
  void receive(std::string_view datagram, std::int64_t now);

  /// Gives the node the wrench of the newest record, if one has come since the last time. To be
  /// called before each tick.
  void hand_over(Node* node, std::int64_t now);

  /// Is the sensor to be asked to stream? True once each time.
  bool wants_request(std::int64_t now);

  /// Adds counters to those of the other links.
  void add_to(LinkState* state) const;
  void forget_conflicts() { sequence_.clear_conflict(); }

 private:
  static constexpr std::uint32_t kModulus = std::uint32_t{1} << 31U;
  /// Records in a row, of up to eight thousand a second.
  static constexpr std::uint32_t kTolerated = 400;

  RdtConfig config_;
  SequenceMonitor sequence_{kModulus, kTolerated, true};
  RdtRecord newest_;
  bool has_newest_ = false;
  std::int64_t ask_at_ = 0;  ///< ns, to stream, unless a record comes before
};

}  // namespace flexcomp
