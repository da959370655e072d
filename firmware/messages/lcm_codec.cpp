#include "messages/lcm_codec.hpp"

#include "messages/lcm/commands.hpp"
#include "messages/lcm/measurements.hpp"
#include "messages/lcm/reports.hpp"
#include "messages/lcm/setpoints.hpp"
#include "messages/lcm/transfer.hpp"

namespace flexcomp {
namespace {

char to_capital(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

template <typename Type>
const std::string& channel_of() {
  static const std::string channel = [] {
    std::string name = Type::getTypeName();
    std::transform(name.begin(), name.end(), name.begin(), to_capital);
    return "FLEXCOMP_" + name;
  }();
  return channel;
}

/// Encodes a message of any kind.
struct Encoder {
  std::int64_t sequence;
  std::int64_t now;

  LcmEvent operator()(std::monostate /*nothing*/) const { return {}; }

  template <typename Content>
  LcmEvent operator()(const Content& message) const {
    using Type = typename lcm::Event<Content>::Type;
    Type type{};
    type.sequence = sequence;
    type.timestamp = now;
    lcm::Event<Content>::write(message, &type);
    LcmEvent event;
    event.channel = channel_of<Type>();
    event.data.resize(static_cast<std::size_t>(type.getEncodedSize()));
    type.encode(event.data.data(), 0, static_cast<int>(event.data.size()));
    return event;
  }
};

/// Decodes into `result` if the channel is that of `Content`.
template <typename Content>
bool try_decode(const std::string& channel, const void* data, std::size_t size,
                LcmMessage* result) {
  using Type = typename lcm::Event<Content>::Type;
  if (channel != channel_of<Type>()) {
    return false;
  }
  Type type{};
  if (type.decode(data, 0, static_cast<int>(size)) >= 0) {
    *result = {lcm::Event<Content>::read(type), type.sequence, type.timestamp};
  }
  return true;
}

template <typename... Contents>
LcmMessage decode_any(const std::variant<std::monostate, Contents...>* /*messages*/,
                      const std::string& channel, const void* data, std::size_t size) {
  LcmMessage result;
  (try_decode<Contents>(channel, data, size, &result) || ...);
  return result;
}

}  // namespace

LcmEvent encode_lcm(const Message& message, std::int64_t sequence, std::int64_t now) {
  return std::visit(Encoder{sequence, now}, message);
}

LcmMessage decode_lcm(const std::string& channel, const void* data, std::size_t size) {
  return decode_any(static_cast<const Message*>(nullptr), channel, data, size);
}

}  // namespace flexcomp
