#pragma once

#include <array>

#include "messages/authentication_counters.hpp"
#include "messages/can_encoder.hpp"
#include "messages/can_layout.hpp"
#include "messages/cmac.hpp"
#include "messages/freshness.hpp"

namespace flexcomp {

/// The frames of one message and the one that authenticates them.
struct SealedFrames {
  std::array<CanFrame, kMaxFrameParts + 1> frames{};
  std::size_t count = 0;
};

/// Authenticates messages on CAN with a key that both sides hold, after AUTOSAR's SecOC: a frame of
/// its own carries part of a freshness value and of an AES-CMAC over message and freshness (said in
/// flexcomp.dbc). Stands between the bus and encoder and decoder, which know nothing of it.
///
/// Covered is what has a frame for it (`find_authentication`); all else goes through unchanged.
/// Fixed memory after construction, constant time.
class MessageAuthentication {
 public:
  MessageAuthentication(const AuthenticationKey& key, FreshnessClock clock);

  /// The frames of a message as the encoder made them, with its authentication. What is returned is
  /// overwritten by the next call.
  const SealedFrames& seal(const FrameList& message);

  /// Returns the frames that may go on to the decoder now that this one has come: those of a
  /// covered message once its authentication comes, which is the last of them; a frame that is not
  /// covered itself. The next call overwrites the list.
  const FrameList& admit(const CanFrame& frame);

  const AuthenticationCounters& counters() const { return counters_; }

 private:
  /// The last of each part of a message. They stay when an authentication does not fit them, which
  /// may be a forged one before the genuine.
  struct Pending {
    std::uint32_t received = 0;  ///< one bit a part
    bool is_counted = false;     ///< as refused
    std::array<CanFrame, kMaxFrameParts> parts{};
  };

  void collect(const CanFrame& frame, std::size_t part, Pending* pending);
  void conclude(const AuthenticationLayout& layout, const CanFrame& authentication,
                Pending* pending);
  bool is_authentic(const AuthenticationLayout& layout, const CanFrame& authentication,
                    const Pending& pending);
  bool make_authentication(const AuthenticationLayout& layout, const CanFrame* message,
                           Freshness freshness, CanFrame* frame);

  Cmac cmac_;
  FreshnessClock clock_;
  FreshnessSource source_;
  std::array<FreshnessGate, kFrameGroups> gates_;
  std::array<Pending, kFrameGroups> pending_{};
  AuthenticationCounters counters_;
  SealedFrames sealed_;
  FrameList admitted_;
};

}  // namespace flexcomp
