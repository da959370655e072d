#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "linux/options.hpp"

namespace flexcomp {

/// Adds options to a command line. Each is added as one that may change while the program runs, or
/// as one that only the start reads: there is no third way, so none is forgotten.
class OptionList {
 public:
  explicit OptionList(CLI::App* app) : app_(app) {}

  /// May change: `Node::configure` takes its new value.
  template <typename Value>
  CLI::Option* add_changeable(const std::string& name, Value* value, const std::string& help) {
    return add(name, value, help)->group("Options, read again on SIGHUP");
  }

  /// Read at start only. `value` outlives this.
  template <typename Value>
  CLI::Option* add_fixed(const std::string& name, Value* value, const std::string& help) {
    texts_.push_back({name.substr(2), [value] { return text(*value); }});  // without the dashes
    return add(name, value, help)->group("Options, read at start only");
  }

  /// Names and values of those that are read at start only; once all is parsed.
  std::vector<FixedOption> fixed() const {
    std::vector<FixedOption> all;
    for (const Text& text : texts_) {
      all.push_back({text.name, text.value()});
    }
    return all;
  }

 private:
  struct Text {
    std::string name;
    std::function<std::string()> value;
  };

  template <typename Value>
  CLI::Option* add(const std::string& name, Value* value, const std::string& help) {
    if constexpr (std::is_same_v<Value, bool>) {
      return app_->add_flag(name, *value, help);
    } else {
      return app_->add_option(name, *value, help);
    }
  }

  /// The same for what is the same number, however it was typed.
  template <typename Value>
  static std::string text(const Value& value) {
    if constexpr (std::is_convertible_v<Value, std::string>) {
      return value;
    } else if constexpr (std::is_same_v<Value, std::vector<double>>) {
      std::string all;
      for (const double number : value) {
        all += text(number) + " ";
      }
      return all;
    } else if constexpr (std::is_floating_point_v<Value>) {
      constexpr int kDigits = 17;
      std::array<char, 32> digits{};
      std::snprintf(digits.data(), digits.size(), "%.*g", kDigits, static_cast<double>(value));
      return digits.data();
    } else {
      return std::to_string(static_cast<long long>(value));
    }
  }

  CLI::App* app_;
  std::vector<Text> texts_;
};

}  // namespace flexcomp
