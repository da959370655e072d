#include "rsi/answer.hpp"

#include <algorithm>
#include <cmath>

namespace flexcomp {
namespace {

constexpr std::uint64_t kUnitsADegree = 1'000'000;
constexpr std::array<std::string_view, 6> kAttributes = {" A1=\"",   "\" A2=\"", "\" A3=\"",
                                                         "\" A4=\"", "\" A5=\"", "\" A6=\""};

}  // namespace

void RsiAnswerText::write(const RsiAnswer& answer) {
  size_ = 0;
  add("<Sen Type=\"");
  add(answer.type);
  add("\"><");
  add(answer.correction_name);
  for (std::size_t i = 0; i < kAttributes.size(); ++i) {
    add(kAttributes[i]);
    add_degrees(answer.correction[i]);
  }
  add("\"/>");
  if (!answer.state_name.empty()) {
    add("<");
    add(answer.state_name);
    add(">");
    add_whole(answer.state);
    add("</");
    add(answer.state_name);
    add(">");
  }
  add("<IPOC>");
  add_whole(answer.ipoc);
  add("</IPOC></Sen>");
}

void RsiAnswerText::add(std::string_view text) {
  const std::string_view fitting = text.substr(0, kRoom - size_);
  std::copy(fitting.begin(), fitting.end(), text_.data() + size_);
  size_ += fitting.size();
}

void RsiAnswerText::add_whole(std::uint64_t number) {
  constexpr std::size_t kMostDigits = 20;
  std::array<char, kMostDigits> digits{};
  std::size_t begin = kMostDigits;
  do {
    digits[--begin] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number != 0);
  add({digits.data() + begin, kMostDigits - begin});
}

void RsiAnswerText::add_degrees(double degrees) {
  const auto units =
      static_cast<std::uint64_t>(std::llround(std::abs(degrees) * double{kUnitsADegree}));
  add(degrees < 0 && units != 0 ? "-" : "");
  add_whole(units / kUnitsADegree);
  add(".");
  for (std::uint64_t place = kUnitsADegree / 10; place > 0; place /= 10) {
    add_whole(units / place % 10);
  }
}

}  // namespace flexcomp
