#include "rsi/telegram.hpp"

#include "rsi/decimal.hpp"

namespace flexcomp {
namespace {

constexpr std::size_t kDeepest = 4;  // elements within each other; a controller sends two
constexpr std::size_t kAxes = 6;
using Names = std::array<std::string_view, kAxes>;

constexpr Names kAxisNames = {"A1", "A2", "A3", "A4", "A5", "A6"};
constexpr Names kWrenchNames = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
constexpr std::array<std::string_view, 1> kLateNames = {"D"};

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '.' || c == ':';
}

/// The text from a place on, and steps forward in it.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  bool is_at_end() const { return rest_.empty(); }
  bool is_at(std::string_view text) const { return rest_.substr(0, text.size()) == text; }
  bool take(std::string_view text) {
    const bool is_there = is_at(text);
    rest_.remove_prefix(is_there ? text.size() : 0);
    return is_there;
  }
  /// True if there was a blank.
  bool pass_blanks() {
    const std::size_t before = rest_.size();
    while (!rest_.empty() && is_blank(rest_.front())) {
      rest_.remove_prefix(1);
    }
    return rest_.size() != before;
  }
  std::string_view take_name() {
    std::size_t size = 0;
    while (size < rest_.size() && is_name_character(rest_[size])) {
      ++size;
    }
    return take_front(size);
  }
  /// All before `end`, or before the end of the text.
  std::string_view take_until(std::string_view end) {
    const std::size_t place = rest_.find(end);
    return take_front(place == std::string_view::npos ? rest_.size() : place);
  }

 private:
  std::string_view take_front(std::size_t size) {
    const std::string_view front = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return front;
  }

  std::string_view rest_;
};

/// Numbers in the attributes of an element, and which have been there.
template <std::size_t count>
class NumberAttributes {
 public:
  explicit NumberAttributes(const std::array<std::string_view, count>& names) : names_(names) {}

  RsiReading take(std::string_view name, std::string_view text) {
    for (std::size_t i = 0; i < count; ++i) {
      if (name != names_[i]) {
        continue;
      }
      if ((seen_ >> i & 1U) != 0) {
        return RsiReading::repeated;
      }
      seen_ |= 1U << i;
      return read_decimal(text, &values_[i]) ? RsiReading::ok : RsiReading::no_number;
    }
    return RsiReading::ok;
  }

  bool is_complete() const { return seen_ == (1U << count) - 1U; }
  const std::array<double, count>& values() const { return values_; }

 private:
  std::array<std::string_view, count> names_;
  std::array<double, count> values_{};
  unsigned seen_ = 0;
};

/// Takes the elements of a telegram's root as they come, and keeps what the schema names.
class Contents {
 public:
  explicit Contents(const RsiSchema& schema) : schema_(schema) {}

  RsiReading begin(std::string_view name) {
    current_ = kind_of(name);
    text_ = {};
    is_in_pieces_ = false;
    if (current_ == kOther) {
      return RsiReading::ok;
    }
    const unsigned bit = 1U << current_;
    if ((seen_ & bit) != 0) {
      return RsiReading::repeated;
    }
    seen_ |= bit;
    return RsiReading::ok;
  }

  RsiReading attribute(std::string_view name, std::string_view text) {
    switch (current_) {
      case kActual:
        return actual_.take(name, text);
      case kSetpoint:
        return setpoint_.take(name, text);
      case kWrench:
        return wrench_.take(name, text);
      case kApplied:
        return applied_.take(name, text);
      case kLate:
        return name == kLateNames[0] ? take_late(text) : RsiReading::ok;
      default:
        return RsiReading::ok;
    }
  }

  void text(std::string_view text) {
    text = without_blanks(text);
    is_in_pieces_ = is_in_pieces_ || (!text_.empty() && !text.empty());
    text_ = text_.empty() ? text : text_;
  }

  RsiReading end() {
    if (current_ == kIpoc) {
      const bool is_number = !is_in_pieces_ && read_unsigned(text_, &ipoc_);
      return is_number ? RsiReading::ok : RsiReading::no_number;
    }
    return current_ == kArmed ? take_armed() : RsiReading::ok;
  }

  RsiReading conclude(RsiTelegram* telegram) const {
    const bool is_whole = has(kIpoc) && actual_.is_complete() && setpoint_.is_complete() &&
                          (schema_.wrench.empty() || wrench_.is_complete()) &&
                          (schema_.armed.empty() || has(kArmed)) &&
                          (schema_.applied.empty() || applied_.is_complete()) &&
                          (!schema_.needs_late || late_.has_value());
    if (!is_whole) {
      return RsiReading::missing;
    }
    telegram->actual = actual_.values();
    telegram->setpoint = setpoint_.values();
    telegram->ipoc = ipoc_;
    telegram->late = late_;
    telegram->wrench = schema_.wrench.empty() ? std::nullopt : std::optional(wrench_.values());
    telegram->armed = armed_;
    telegram->applied = schema_.applied.empty() ? std::nullopt : std::optional(applied_.values());
    return RsiReading::ok;
  }

 private:
  enum Kind : unsigned { kActual, kSetpoint, kIpoc, kLate, kWrench, kArmed, kApplied, kOther };

  Kind kind_of(std::string_view name) const {
    if (name == "AIPos") {
      return kActual;
    }
    if (name == "ASPos") {
      return kSetpoint;
    }
    if (name == "IPOC") {
      return kIpoc;
    }
    if (name == "Delay") {
      return kLate;
    }
    if (name == schema_.wrench) {
      return kWrench;
    }
    if (name == schema_.applied) {
      return kApplied;
    }
    return name == schema_.armed ? kArmed : kOther;
  }

  bool has(Kind kind) const { return (seen_ >> kind & 1U) != 0; }

  RsiReading take_late(std::string_view text) {
    std::uint64_t late = 0;
    if (late_) {
      return RsiReading::repeated;
    }
    if (!read_unsigned(text, &late)) {
      return RsiReading::no_number;
    }
    late_ = late;
    return RsiReading::ok;
  }

  RsiReading take_armed() {
    const bool is_set = text_ == "1" || text_ == "TRUE" || text_ == "true";
    const bool is_clear = text_ == "0" || text_ == "FALSE" || text_ == "false";
    armed_ = is_set;
    return !is_in_pieces_ && (is_set || is_clear) ? RsiReading::ok : RsiReading::no_number;
  }

  const RsiSchema& schema_;
  Kind current_ = kOther;
  unsigned seen_ = 0;
  std::string_view text_;
  bool is_in_pieces_ = false;  ///< elements stand between parts of the text
  NumberAttributes<kAxes> actual_{kAxisNames};
  NumberAttributes<kAxes> setpoint_{kAxisNames};
  NumberAttributes<kAxes> wrench_{kWrenchNames};
  NumberAttributes<kAxes> applied_{kAxisNames};
  std::uint64_t ipoc_ = 0;
  std::optional<std::uint64_t> late_;
  std::optional<bool> armed_;
};

/// Goes through the XML and hands over the elements one level below the root.
class Reader {
 public:
  Reader(std::string_view text, const RsiSchema& schema) : scanner_(text), contents_(schema) {}

  RsiReading read(RsiTelegram* telegram) {
    RsiReading result = pass_declaration();
    while (result == RsiReading::ok && !is_done()) {
      result = step();
    }
    if (result != RsiReading::ok) {
      return result;
    }
    return root_was_closed_ ? contents_.conclude(telegram) : RsiReading::no_xml;
  }

 private:
  bool is_done() {
    if (!root_was_closed_) {
      return scanner_.is_at_end();
    }
    scanner_.pass_blanks();
    return scanner_.is_at_end();
  }

  RsiReading pass_declaration() {
    scanner_.take("\xEF\xBB\xBF");  // byte order mark
    scanner_.pass_blanks();
    if (scanner_.take("<?")) {
      scanner_.take_until("?>");
      return scanner_.take("?>") ? RsiReading::ok : RsiReading::no_xml;
    }
    return RsiReading::ok;
  }

  /// Text, and the tag that follows it.
  RsiReading step() {
    const std::string_view text = scanner_.take_until("<");
    if (depth_ == 0 && !without_blanks(text).empty()) {
      return RsiReading::no_xml;
    }
    if (depth_ == 2) {
      contents_.text(text);
    }
    if (scanner_.is_at_end()) {
      return depth_ == 0 ? RsiReading::ok : RsiReading::no_xml;
    }
    return scanner_.take("</") ? close() : open();
  }

  RsiReading open() {
    scanner_.take("<");
    const std::string_view name = scanner_.take_name();
    if (name.empty() || root_was_closed_) {
      return RsiReading::no_xml;
    }
    if (depth_ == kDeepest) {
      return RsiReading::too_deep;
    }
    if (depth_ == 0 && name != "Rob") {
      return RsiReading::no_rob;
    }
    names_[depth_++] = name;
    const RsiReading begun = depth_ == 2 ? contents_.begin(name) : RsiReading::ok;
    return begun == RsiReading::ok ? attributes() : begun;
  }

  RsiReading attributes() {
    while (true) {
      const bool is_apart = scanner_.pass_blanks();
      if (scanner_.take("/>")) {
        return leave();
      }
      if (scanner_.take(">")) {
        return RsiReading::ok;
      }
      const RsiReading result = is_apart ? attribute() : RsiReading::no_xml;
      if (result != RsiReading::ok) {
        return result;
      }
    }
  }

  RsiReading attribute() {
    const std::string_view name = scanner_.take_name();
    scanner_.pass_blanks();
    if (name.empty() || !scanner_.take("=")) {
      return RsiReading::no_xml;
    }
    scanner_.pass_blanks();
    const std::string_view quote = scanner_.is_at("\"") ? "\"" : "'";
    if (!scanner_.take(quote)) {
      return RsiReading::no_xml;
    }
    const std::string_view text = scanner_.take_until(quote);
    if (!scanner_.take(quote) || text.find('<') != std::string_view::npos) {
      return RsiReading::no_xml;
    }
    return depth_ == 2 ? contents_.attribute(name, text) : RsiReading::ok;
  }

  RsiReading close() {
    const std::string_view name = scanner_.take_name();
    scanner_.pass_blanks();
    const bool fits = depth_ > 0 && name == names_[depth_ - 1] && scanner_.take(">");
    return fits ? leave() : RsiReading::no_xml;
  }

  RsiReading leave() {
    const RsiReading result = depth_ == 2 ? contents_.end() : RsiReading::ok;
    --depth_;
    root_was_closed_ = depth_ == 0;
    return result;
  }

  Scanner scanner_;
  Contents contents_;
  std::array<std::string_view, kDeepest> names_;
  std::size_t depth_ = 0;
  bool root_was_closed_ = false;
};

/// Without the zeros that end a text in C.
std::string_view without_end_mark(std::string_view text) {
  while (!text.empty() && text.back() == '\0') {
    text.remove_suffix(1);
  }
  return text;
}

}  // namespace

const char* describe(RsiReading reading) {
  switch (reading) {
    case RsiReading::ok:
      return "ok";
    case RsiReading::too_long:
      return "longer than a telegram may be";
    case RsiReading::no_xml:
      return "not well-formed XML";
    case RsiReading::too_deep:
      return "elements nested too deep";
    case RsiReading::no_rob:
      return "the root is not Rob";
    case RsiReading::missing:
      return "an element or attribute is missing";
    case RsiReading::repeated:
      return "an element or attribute is there twice";
    case RsiReading::no_number:
      return "no number where one must be";
  }
  return "unknown";
}

RsiReading read_telegram(std::string_view text, const RsiSchema& schema, RsiTelegram* telegram) {
  if (text.size() > kLongestTelegram) {
    return RsiReading::too_long;
  }
  return Reader(without_end_mark(text), schema).read(telegram);
}

}  // namespace flexcomp
