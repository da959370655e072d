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
  /// Throws std::runtime_error as Cmac does.
  MessageAuthentication(const AuthenticationKey& key, FreshnessClock clock);

  /// The frames of a message as the encoder made them, with its authentication. What is returned is
  /// overwritten by the next call.
  const SealedFrames& seal(const FrameList& message);

  /// What may go on to the decoder now that this frame has come: the frames of a covered message,
  /// once all of them are there and authentic; any other frame itself. What is returned is
  /// overwritten by the next call.
  const FrameList& admit(const CanFrame& frame);

  const AuthenticationCounters& counters() const { return counters_; }

 private:
  /// Frames of a message on their way in; its authentication is the last.
  struct Pending {
    std::uint32_t received = 0;  ///< one bit a frame
    std::uint32_t counter = 0;
    std::array<CanFrame, kMaxFrameParts + 1> frames{};
  };

  void collect(const CanFrame& frame, std::size_t part, Pending* pending);
  bool is_authentic(const AuthenticationLayout& layout, const Pending& pending);
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
