#include "diagnosis/grammar/known.hpp"

#include <algorithm>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

template <typename Item>
bool has(const std::vector<Item>& all, const Item& item) {
  return std::find(all.begin(), all.end(), item) != all.end();
}

/// Does a lead follow a signal of the joint, or the component of the wrench, that it acts at?
bool is_by_own_signal(const Lead& lead) {
  const bool is_same_component = lead.seat->place.kind != PlaceKind::sensor_wrench ||
                                 "sensor " + lead.driver->name == lead.seat->name + "_tool";
  return !lead.driver->is_product && lead.driver->joint == lead.seat->place.joint &&
         is_same_component;
}

/// Do both have no factor, or is the lead's one of that kind?
bool has_factor(const Lead& lead, const std::string& factor) {
  return factor.empty() ? lead.factor.text.empty()
                        : lead.factor.text.compare(0, factor.size(), factor) == 0;
}

}  // namespace

std::string known_as(const Lead& lead, const Shape& shape) {
  if (!is_by_own_signal(lead)) {
    return "";
  }
  const auto is_it = [&](const Known& known) {
    return has(known.places, lead.seat->place.kind) && has_factor(lead, known.factor) &&
           has(known.drivers, lead.driver->kind) && has<std::string>(known.shapes, shape.name);
  };
  for (const auto& [effect, search] : searches()) {
    if (std::any_of(search.known.begin(), search.known.end(), is_it)) {
      return effect;
    }
  }
  return "";
}

std::string constant_as(const Lead& lead) {
  if (!lead.factor.text.empty()) {
    return "";
  }
  for (const auto& [effect, search] : searches()) {
    if (has(search.constant_at, lead.seat->place.kind)) {
      return effect;
    }
  }
  return "";
}

std::string factor_as(const Material& material, const Lead& lead) {
  const Driver* driver = find_driver(material.drivers, lead.factor.signal);
  if (driver == nullptr) {
    return "";
  }
  const Shape& shape = shape_named(lead.factor.text == lead.factor.signal ? "line" : "sign");
  return known_as({lead.seat, driver, {}, 0, 0}, shape);
}

}  // namespace flexcomp::diagnosis::grammar
