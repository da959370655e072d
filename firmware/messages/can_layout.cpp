#include "messages/can_layout.hpp"

#include <array>

#include "messages/e2e.hpp"

namespace flexcomp {
namespace {

/// One row for each frame of a message, after those that are there.
template <typename Format, std::size_t Rows, typename... Frames>
constexpr void add_frames(std::array<FrameLayout, Rows>* layouts, std::size_t* count,
                          const can::FrameSet<Frames...>& /*format*/) {
  std::uint8_t part = 0;
  (((*layouts)[(*count)++] = {Frames::kId, Frames::kSize, Frames::kFd,
                              FrameGroup{can::kPlace<Format>}, part++, Format::kParts,
                              crc8_of_identifier(Frames::kId),
                              static_cast<std::uint8_t>(1U << (part - 1)),
                              static_cast<std::uint8_t>((1U << Format::kParts) - 1U)}),
   ...);
}

template <typename... Formats>
constexpr auto make_layouts(const std::tuple<Formats...>& /*formats*/) {
  std::array<FrameLayout, (std::size_t{Formats::kParts} + ...)> layouts{};
  std::size_t count = 0;
  (add_frames<Formats>(&layouts, &count, Formats()), ...);
  return layouts;
}

constexpr auto kLayouts = make_layouts(can::Formats());

template <typename Format, std::size_t Rows>
constexpr void add_authentication(std::array<AuthenticationLayout, Rows>* layouts,
                                  std::size_t* count) {
  using Frame = typename Format::Authentication;
  if constexpr (!std::is_void_v<Frame>) {
    (*layouts)[(*count)++] = {Frame::kId, Frame::kSize, Frame::kFd, FrameGroup{can::kPlace<Format>},
                              Format::kParts};
  }
}

template <typename... Formats>
constexpr auto make_authentications(const std::tuple<Formats...>& /*formats*/) {
  constexpr std::size_t kRows =
      (std::size_t{!std::is_void_v<typename Formats::Authentication>} + ...);
  std::array<AuthenticationLayout, kRows> layouts{};
  std::size_t count = 0;
  (add_authentication<Formats>(&layouts, &count), ...);
  return layouts;
}

constexpr auto kAuthentications = make_authentications(can::Formats());

template <typename Condition>
const AuthenticationLayout* first_with(const Condition& holds) {
  const auto* found = std::find_if(kAuthentications.begin(), kAuthentications.end(), holds);
  return found == kAuthentications.end() ? nullptr : found;
}

constexpr std::uint32_t largest_id() {
  std::uint32_t largest = 0;
  for (const FrameLayout& layout : kLayouts) {
    largest = std::max(largest, layout.id);
  }
  return largest;
}

constexpr std::uint32_t kMostId = largest_id();
constexpr std::uint8_t kNone = 0xFF;

/// For each identifier the place of its layout.
constexpr std::array<std::uint8_t, kMostId + 1> make_index() {
  std::array<std::uint8_t, kMostId + 1> index{};
  for (std::uint8_t& place : index) {
    place = kNone;
  }
  for (std::size_t i = 0; i < kLayouts.size(); ++i) {
    index[kLayouts[i].id] = static_cast<std::uint8_t>(i);
  }
  return index;
}

constexpr std::array<std::uint8_t, kMostId + 1> kIndex = make_index();

}  // namespace

const FrameLayout* find_layout(std::uint32_t id) {
  return id <= kMostId && kIndex[id] != kNone ? &kLayouts[kIndex[id]] : nullptr;
}

const AuthenticationLayout* find_authentication(std::uint32_t id) {
  return first_with([id](const AuthenticationLayout& layout) { return layout.id == id; });
}

const AuthenticationLayout* find_authentication(FrameGroup group) {
  return first_with([group](const AuthenticationLayout& layout) { return layout.group == group; });
}

}  // namespace flexcomp
