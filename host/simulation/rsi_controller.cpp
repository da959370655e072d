#include "simulation/rsi_controller.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <tinyxml.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "error.hpp"
#include "linux/clock.hpp"
#include "linux/udp_socket.hpp"
#include "simulation/wait_for_input.hpp"

namespace flexcomp::simulation {
namespace {

constexpr std::array<const char*, 6> kAxisNames = {"A1", "A2", "A3", "A4", "A5", "A6"};
constexpr std::array<const char*, 6> kWrenchNames = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};

/// Four decimals, as RSI's object ETHERNET gives with a Precision of 4.
std::string element(const char* name, const std::array<const char*, 6>& attributes,
                    const std::array<double, 6>& values) {
  std::string text = fmt::format("<{}", name);
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += fmt::format(" {}=\"{:.4f}\"", attributes[i], values[i]);
  }
  return text + "/>";
}

/// An answer, read by another library than the one that wrote it.
struct Answer {
  std::uint64_t ipoc = 0;
  std::string type;
  AxisAngles correction{};
  std::uint8_t state = 0;
};

bool read_answer(const std::string& text, Answer* answer) {
  TiXmlDocument document;
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  const TiXmlHandle sen = TiXmlHandle(&document).FirstChild("Sen");
  const TiXmlElement* root = sen.ToElement();
  const TiXmlElement* correction = sen.FirstChild("AK").ToElement();
  const TiXmlText* ipoc = sen.FirstChild("IPOC").FirstChild().ToText();
  const TiXmlText* state = sen.FirstChild("State").FirstChild().ToText();
  if (document.Error() || root == nullptr || correction == nullptr || ipoc == nullptr ||
      root->Attribute("Type") == nullptr) {
    return false;
  }
  for (std::size_t i = 0; i < kAxisNames.size(); ++i) {
    const bool is_number =
        correction->QueryDoubleAttribute(kAxisNames[i], &answer->correction[i]) == TIXML_SUCCESS &&
        std::isfinite(answer->correction[i]);
    if (!is_number) {
      return false;
    }
  }
  answer->type = root->Attribute("Type");
  answer->ipoc = std::strtoull(ipoc->Value(), nullptr, 10);
  answer->state = state == nullptr
                      ? std::uint8_t{0}
                      : static_cast<std::uint8_t>(std::strtol(state->Value(), nullptr, 10));
  return true;
}

class RsiController : public PlantBus {
 public:
  RsiController(const std::string& address, const RsiControllerOptions& options)
      : options_(options),
        cycle_(static_cast<std::uint64_t>(std::llround(1e3 * options.period))),
        socket_(UdpSocket::to(address)) {}

  void send(const Message& message) override {
    if (const auto* wrench = std::get_if<WrenchMessage>(&message)) {
      wrench_ = wrench->wrench;
    } else if (const auto* command = std::get_if<CommandMessage>(&message)) {
      armed_ = command->command == Command::arm;
    } else if (const auto* setpoint = std::get_if<SetpointMessage>(&message)) {
      begin_cycle(*setpoint);
    }
  }

  bool receive(Message* message, std::int64_t patience) override {
    const std::int64_t until = monotonic_now() + patience;
    while (true) {
      std::array<char, 2048> data{};
      sockaddr_in from{};
      const long size = socket_.receive(data.data(), data.size(), &from);
      if (size >= 0 && take({data.data(), static_cast<std::size_t>(size)})) {
        *message = corrected();
        return true;
      }
      const std::int64_t left = until - monotonic_now();
      if (size < 0 && (left <= 0 || !wait_for_input(socket_.number(), left))) {
        return false;
      }
    }
  }

 private:
  void begin_cycle(const SetpointMessage& setpoint) {
    late_ += has_begun_ && !answered_ ? 1U : 0U;
    if (late_ > options_.tolerated) {
      throw RsiStopped(fmt::format("RSI stopped the robot: {} answers were late, {} are tolerated",
                                   late_, options_.tolerated));
    }
    has_begun_ = true;
    answered_ = false;
    setpoint_ = setpoint;
    ipoc_ += cycle_;
    socket_.send(telegram());
  }

  std::string telegram() const {
    const AxisAngles setpoint = options_.axes.to_axes(setpoint_.q);
    AxisAngles actual{};
    std::transform(setpoint.begin(), setpoint.end(), correction_.begin(), actual.begin(),
                   std::plus<>());
    return "<Rob Type=\"KUKA\">" + element("AIPos", kAxisNames, actual) +
           element("ASPos", kAxisNames, setpoint) +
           fmt::format("<Delay D=\"{}\"/><Arm>{}</Arm>", late_, armed_ ? 1 : 0) +
           element("AxisCorrMon", kAxisNames, correction_) + element("FT", kWrenchNames, wrench_) +
           fmt::format("<IPOC>{}</IPOC></Rob>", ipoc_);
  }

  /// True if it is the answer to this cycle's telegram, and the first.
  bool take(const std::string& text) {
    Answer answer;
    if (answered_ || !read_answer(text, &answer) || answer.ipoc != ipoc_ ||
        answer.type != options_.type) {
      return false;
    }
    answered_ = true;
    state_ = answer.state;
    for (std::size_t i = 0; i < correction_.size(); ++i) {
      correction_[i] = options_.mode == RsiMode::absolute ? answer.correction[i]
                                                          : correction_[i] + answer.correction[i];
      if (std::abs(correction_[i]) > options_.largest_correction) {
        throw RsiStopped(fmt::format("RSI stopped the robot: a correction of {:.3f} degrees of A{}",
                                     correction_[i], i + 1));
      }
    }
    return true;
  }

  CorrectedMessage corrected() const {
    CorrectedMessage message;
    const JointAngles difference = options_.axes.to_difference(correction_);
    message.uncorrected = setpoint_.q;
    std::transform(setpoint_.q.begin(), setpoint_.q.end(), difference.begin(),
                   message.corrected.begin(), std::plus<>());
    message.state = state_;
    return message;
  }

  RsiControllerOptions options_;
  std::uint64_t cycle_;  ///< ms
  UdpSocket socket_;
  SetpointMessage setpoint_;
  std::array<double, 6> wrench_{};
  bool armed_ = false;
  AxisAngles correction_{};  ///< degrees, that the robot moves by
  std::uint64_t ipoc_ = 4'208'163'634;
  std::uint64_t late_ = 0;
  bool has_begun_ = false;
  bool answered_ = false;
  std::uint8_t state_ = 0;
};

}  // namespace

std::unique_ptr<PlantBus> open_rsi_controller(const std::string& address,
                                              const RsiControllerOptions& options) {
  try {
    return std::make_unique<RsiController>(address, options);
  } catch (const std::runtime_error& error) {
    throw InputError(error.what());
  }
}

}  // namespace flexcomp::simulation
