#pragma once

#include "node/node.hpp"
#include "rsi/answer.hpp"
#include "rsi/session.hpp"
#include "rsi/telegram.hpp"

namespace flexcomp {

/// How the controller takes `AK`: as RSI is started there (RSI_ON).
enum class RsiMode : std::uint8_t {
  absolute = 0,  ///< the whole correction
  relative = 1,  ///< what is added to it; needs the element Delay
};

struct RsiConfig {
  AxisConvention axes;
  RsiMode mode = RsiMode::absolute;
  double largest = 1.0;        ///< degrees, of the whole correction of an axis
  double largest_step = 0.05;  ///< degrees, from one answer to the next
  RsiSchema schema;
  std::string_view type = "ImFree";  ///< SENTYPE of the controller's configuration
  std::string_view correction_name = "AK";
  std::string_view state_name;  ///< element of the answer with the node's state; empty: none
  std::uint32_t tolerated_losses = 3;
};

/// A node's side of RSI, whatever moves the datagrams: takes telegrams, hands the node setpoint,
/// wrench and commands, and turns its corrected setpoints into answers. No allocation, no I/O.
///
/// Rules, beside the node's own:
/// - Every telegram that is used gets one answer, at once, with its IPOC; one that is repeated gets
///   the same again. What cannot be read, comes out of order or from a second controller gets none.
/// - A new session (RsiSession) disarms. Until the node's correction is zero the answers go to zero
///   from the correction that the controller says it moves by. Where it does not say, that is taken
///   to be zero, as it is after RSI was started.
/// - The answers have limits of their own, in size and from one to the next.
/// - The output for arming, where the schema names one, arms as it rises and disarms as it falls.
///   It must have been seen low in the session. Until the node is ready it is asked again, for five
///   seconds. A rise also takes back a latched fault. Telegrams that cease cannot leave the
///   node armed: without setpoints it holds, fades and latches.
/// - Relative: what an answer adds is taken back from the sum that is kept of them if the
///   controller says that the answer was late.
class RsiLink {
 public:
  /// The names in `config` must outlive this.
  explicit RsiLink(const RsiConfig& config) : config_(config), session_(config.tolerated_losses) {}

  /// The action that a datagram asks of who moves it.
  enum class Due : std::uint8_t {
    nothing,
    tick,      ///< a setpoint came: an answer is due, after a tick if there is one
    answer,    ///< an answer is due
    the_same,  ///< the last answer is to be sent again
  };

  Due receive(std::string_view datagram, RsiPeer peer, Node* node, std::int64_t now);

  /// To be called after each tick with what the node sends.
  void observe(const CorrectedMessage& corrected);

  /// The answer to the last telegram that was used; the same until the next one.
  std::string_view answer();

  bool needs_answer() const { return needs_answer_; }
  std::string_view last_answer() const { return text_.text(); }

  /// Adds counters and conflicts to those of the other links.
  void add_to(LinkState* state) const;
  void forget_conflicts() { session_.clear_conflict(); }

 private:
  void begin_session(const RsiTelegram& telegram, Node* node);
  void hand_over(const RsiTelegram& telegram, Node* node, std::int64_t now);
  void follow_output(bool armed, Node* node, std::int64_t now);
  void take_back_late_answer();
  double next_total(std::size_t axis, bool* is_limited) const;

  RsiConfig config_;
  RsiSession session_;
  RsiTelegram telegram_;
  RsiAnswerText text_;
  bool needs_answer_ = false;

  AxisAngles wanted_{};  ///< degrees, the correction that the node wants
  AxisAngles total_{};   ///< degrees, the correction that the controller has, all answers in it
  AxisAngles added_{};   ///< degrees, by the last answer
  std::uint8_t state_ = 0;
  bool waits_for_zero_ = false;  ///< the node still corrects for an earlier session

  std::optional<bool> output_;  ///< for arming, as it was last seen in this session
  bool wants_to_arm_ = false;
  std::int64_t ask_again_at_ = 0;
  std::int64_t give_up_at_ = 0;

  std::uint32_t corrupt_ = 0;
  std::uint32_t wrenches_ = 0;
  std::uint64_t late_answers_ = 0;
  std::uint32_t limited_answers_ = 0;
};

}  // namespace flexcomp
