#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "flexcomp_can_words.hpp"
#include "messages/messages.hpp"
#include "messages/microseconds.hpp"

/// The files beside this one say for each message what it holds, in the words below. They take what
/// cantools and words_of_dbc.py generate from flexcomp.dbc; checksums and counters are not their
/// business.
namespace flexcomp::can {

/// The frames of a message on classic CAN, and how they are packed and unpacked. Specialised for
/// every message, derived from FrameSet:
///
///     static void pack(const Content& message, RawA* a, RawB* b);   // one for each frame
///     static Content unpack(const RawA& a, const RawB& b);
///
/// where Raw is the generated struct of a frame. `pack` gets them all zero and leaves the counters.
template <typename Content>
struct Classic;

/// The same in FD frames; a message without them has no specialisation, and goes in classic ones.
template <typename Content>
struct Fd;

/// A frame of flexcomp.dbc.
template <typename RawStruct, std::uint32_t Id, std::uint8_t Size>
struct Frame {
  using Raw = RawStruct;
  static constexpr std::uint32_t kId = Id;
  static constexpr std::uint8_t kSize = Size;
  static constexpr bool kFd = Size > 8;  // none of flexcomp.dbc is FD and shorter

  /// For processors whose words begin with their low byte, as all do that this runs on.
  using Payload = std::array<std::uint32_t, Size / sizeof(std::uint32_t)>;
  static Payload pack(const Raw& raw) {
    Payload words;
    Words<Raw>::pack(raw, words.data());
    return words;
  }
  static Raw unpack(const std::uint8_t* data) {
    Payload words;
    std::memcpy(words.data(), data, Size);
    Raw raw{};
    Words<Raw>::unpack(words.data(), &raw);
    return raw;
  }
};

#define DBC_FRAME(NAME, name) \
  Frame<flexcomp_can_##name##_t, FLEXCOMP_CAN_##NAME##_FRAME_ID, FLEXCOMP_CAN_##NAME##_LENGTH>

/// Those that make up a message, in order; what holds where a message says nothing else.
template <typename... Frames>
struct FrameSet {
  static constexpr std::uint8_t kParts = sizeof...(Frames);
  static constexpr bool kFd = (Frames::kFd || ...);
  static_assert(kParts == 1 || ((Frames::kSize == 8) && ...), "a set is of frames of 8 bytes");

  using Authentication = void;  ///< the frame that authenticates it, where a key is configured

  /// After a pause any counter is accepted (SequenceMonitor).
  static constexpr bool kMayRestart = false;

  /// Can the frames hold the message? Else it is not sent.
  template <typename Content>
  static constexpr bool can_hold(const Content& /*message*/) {
    return true;
  }
};

template <typename Format, typename... Frames, std::size_t... Place>
auto unpack(const std::uint8_t* payloads, const FrameSet<Frames...>& /*format*/,
            std::index_sequence<Place...> /*places*/) {
  return Format::unpack(Frames::unpack(payloads + 8 * Place)...);
}

template <typename Format, typename... Frames>
auto unpack(const std::uint8_t* payloads, const FrameSet<Frames...>& format) {
  return unpack<Format>(payloads, format, std::index_sequence_for<Frames...>());
}

/// The message in the payloads of its frames, which lie one after the other.
template <typename Format>
auto unpack(const std::uint8_t* payloads) {
  return unpack<Format>(payloads, Format());
}

/// A scaled signal of `Bits` in a classic frame, between its raw value and physical units. A value
/// that is NaN or does not fit never wraps around: a signed signal then takes its most negative raw
/// value, which means "not available" (said in flexcomp.dbc), an unsigned one its largest.
template <int Bits, auto Fits, auto Encode, auto Decode>
struct Signal {
  using Raw = decltype(Encode(0.0));
  static constexpr bool kSigned = std::is_signed_v<Raw>;
  static constexpr Raw kDoesNotFit =
      static_cast<Raw>(kSigned ? -(1 << (Bits - 1)) : (1 << Bits) - 1);

  static Raw raw(double value) { return Fits(value) ? Encode(value) : kDoesNotFit; }
  static double value(Raw raw) {
    return kSigned && raw == kDoesNotFit ? std::numeric_limits<double>::quiet_NaN() : Decode(raw);
  }
};

#define DBC_SIGNAL(frame, signal, bits)                            \
  Signal<bits, flexcomp_can_##frame##_##signal##_is_in_phys_range, \
         flexcomp_can_##frame##_##signal##_encode, flexcomp_can_##frame##_##signal##_decode>

/// Six angles in three classic frames: q1 and q2, q3 and q4, q5 and q6.
template <typename Q1, typename Q2, typename Q3, typename Q4, typename Q5, typename Q6>
struct JointSignals {
  template <typename RawA, typename RawB, typename RawC>
  static void pack(const JointAngles& q, RawA* a, RawB* b, RawC* c) {
    a->q1 = Q1::raw(q[0]);
    a->q2 = Q2::raw(q[1]);
    b->q3 = Q3::raw(q[2]);
    b->q4 = Q4::raw(q[3]);
    c->q5 = Q5::raw(q[4]);
    c->q6 = Q6::raw(q[5]);
  }

  template <typename RawA, typename RawB, typename RawC>
  static JointAngles unpack(const RawA& a, const RawB& b, const RawC& c) {
    return {Q1::value(a.q1), Q2::value(a.q2), Q3::value(b.q3),
            Q4::value(b.q4), Q5::value(c.q5), Q6::value(c.q6)};
  }
};

/// FD frames hold single precision, NaN included.
inline float single(double value) { return static_cast<float>(value); }

/// The low 32 bits of the sender's clock in µs; wraps after 71 min.
inline std::uint32_t to_microseconds(std::int64_t nanoseconds) {
  return low_microseconds(nanoseconds);
}

inline std::int64_t from_microseconds(std::uint32_t time) { return std::int64_t{1000} * time; }

inline std::uint32_t low_word(std::uint64_t value) {
  return static_cast<std::uint32_t>(value & 0xFFFFFFFFU);
}

inline std::uint32_t high_word(std::uint64_t value) {
  return static_cast<std::uint32_t>(value >> 32);
}

inline std::uint64_t joined(std::uint32_t low, std::uint32_t high) {
  return static_cast<std::uint64_t>(high) << 32 | low;
}

}  // namespace flexcomp::can
