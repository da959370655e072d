// Anything that comes in a datagram. What is read are numbers in their range, as they come back
// from an answer; what is refused leaves the telegram as it was; and reading does not depend on
// what the schema asks for beyond what it asks for.
//
// Input: the bytes.
#include <cmath>
#include <string>

#include "byte_source.hpp"
#include "rsi/answer.hpp"
#include "rsi/telegram.hpp"

using namespace flexcomp;
using flexcomp::fuzz::expect;

namespace {

void check_numbers(const RsiTelegram& telegram) {
  for (std::size_t i = 0; i < 6; ++i) {
    expect(std::isfinite(telegram.actual[i]) && std::isfinite(telegram.setpoint[i]),
           "angles are numbers");
  }
  for (std::size_t i = 0; i < 6; ++i) {
    expect(std::isfinite((*telegram.wrench)[i]) && std::isfinite((*telegram.applied)[i]),
           "forces and corrections are numbers");
  }
}

void check_answer(const RsiTelegram& telegram) {
  RsiAnswer answer;
  answer.type = "ImFree";
  answer.ipoc = telegram.ipoc;
  RsiAnswerText text;
  text.write(answer);
  const std::string end = "<IPOC>" + std::to_string(telegram.ipoc) + "</IPOC></Sen>";
  const std::string written(text.text());
  expect(written.size() > end.size() && written.substr(written.size() - end.size()) == end,
         "an answer ends with the telegram's IPOC");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);  // NOLINT
  RsiSchema all;
  all.wrench = "FT";
  all.armed = "Arm";
  all.applied = "AxisCorrMon";
  all.needs_late = true;
  RsiTelegram telegram;
  telegram.ipoc = 77;
  if (read_telegram(text, all, &telegram) == RsiReading::ok) {
    expect(telegram.wrench && telegram.armed && telegram.applied && telegram.late,
           "all that is asked for is there");
    check_numbers(telegram);
    check_answer(telegram);
    RsiTelegram less;
    expect(read_telegram(text, {}, &less) == RsiReading::ok, "less is asked for and is there");
    expect(less.ipoc == telegram.ipoc && less.setpoint == telegram.setpoint, "and is the same");
  } else {
    expect(telegram.ipoc == 77, "what is refused leaves the telegram as it was");
  }
  return 0;
}
