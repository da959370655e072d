#pragma once

#include <tuple>

#include "messages/can/commands.hpp"
#include "messages/can/measurements.hpp"
#include "messages/can/reports.hpp"
#include "messages/can/setpoints.hpp"
#include "messages/can/transfer.hpp"

namespace flexcomp::can {

/// Is there a specialisation of `Fd`?
template <typename Content, typename = void>
constexpr bool kHasFd = false;
template <typename Content>
constexpr bool kHasFd<Content, std::void_t<decltype(Fd<Content>::kParts)>> = true;

template <typename Content, bool HasFd = kHasFd<Content>>
struct FormatsOf {
  static_assert(!Classic<Content>::kFd);
  using List = std::tuple<Classic<Content>>;
};
template <typename Content>
struct FormatsOf<Content, true> {
  static_assert(!Classic<Content>::kFd && Fd<Content>::kFd);
  using List = std::tuple<Classic<Content>, Fd<Content>>;
};

template <typename Variant>
struct AllFormats;
template <typename... Contents>
struct AllFormats<std::variant<std::monostate, Contents...>> {
  using List = decltype(std::tuple_cat(typename FormatsOf<Contents>::List()...));
};

/// Classic<M>, and Fd<M> where there is one, for each message M of `Message`, in its order.
using Formats = AllFormats<Message>::List;

template <typename Format, typename List>
struct PlaceIn;
template <typename Format, typename... Others>
struct PlaceIn<Format, std::tuple<Format, Others...>> {
  static constexpr std::uint8_t kPlace = 0;
};
template <typename Format, typename First, typename... Others>
struct PlaceIn<Format, std::tuple<First, Others...>> {
  static constexpr std::uint8_t kPlace = PlaceIn<Format, std::tuple<Others...>>::kPlace + 1;
};

/// Number of a format in `Formats`.
template <typename Format>
constexpr std::uint8_t kPlace = PlaceIn<Format, Formats>::kPlace;

}  // namespace flexcomp::can
