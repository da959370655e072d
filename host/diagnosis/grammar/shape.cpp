#include "diagnosis/grammar/shape.hpp"

#include <algorithm>
#include <cmath>

#include "formula/course.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

using effects::SignalKind;

const std::vector<SignalKind> kSigned = {SignalKind::speed,  SignalKind::acceleration,
                                         SignalKind::torque, SignalKind::load,
                                         SignalKind::wrench, SignalKind::tool_wrench};
const std::vector<SignalKind> kAngles = {SignalKind::angle};
const std::vector<SignalKind> kSlow = {SignalKind::time};
const std::vector<SignalKind> kForces = {SignalKind::torque, SignalKind::load, SignalKind::wrench,
                                         SignalKind::tool_wrench, SignalKind::temperature};
const std::vector<SignalKind> kHolding = {SignalKind::angle, SignalKind::torque, SignalKind::load};
const std::vector<SignalKind> kStates = {
    SignalKind::angle,       SignalKind::speed,    SignalKind::acceleration,
    SignalKind::torque,      SignalKind::load,     SignalKind::wrench,
    SignalKind::tool_wrench, SignalKind::position, SignalKind::temperature};

std::vector<Shape> wave_shapes() {
  std::vector<Shape> all;
  for (const char* order : {"", "2*", "3*", "4*", "6*"}) {
    const std::string angle = std::string(order) + "$";
    all.push_back({"wave",
                   {"sin(" + angle + ")", "cos(" + angle + ")"},
                   {},
                   kAngles,
                   ShapeTrait::whole_waves});
  }
  return all;
}

std::vector<Shape> all_shapes() {
  const ShapeParameter scale{"w", Sought::scale};
  const ShapeParameter at{"d", Sought::threshold};
  const ShapeParameter width{"w", Sought::width};
  std::vector<Shape> all = {
      {"line", {"$"}, {}, {}},
      {"size", {"abs($)"}, {}, kSigned},
      {"signed square", {"$*abs($)"}, {}, kSigned},
      {"square", {"$^2"}, {}, kSigned},
      {"cube", {"$^3"}, {}, kSigned},
      {"sign", {"sign($)"}, {}, kSigned},
      {"parabola", {"$", "$^2"}, {}, kStates},
      {"saturation", {"tanh($/w)"}, {scale}, kSigned},
      {"slow saturation", {"$/(w + abs($))"}, {scale}, kSigned},
      {"limit", {"max(-d, min(d, $))"}, {{"d", Sought::scale}}, kSigned},
      {"dead zone", {"($ - d*sign($))*step(abs($) - d)"}, {{"d", Sought::scale}}, kSigned},
      {"stop above", {"($ - d)*step($ - d)"}, {at}, kStates},
      {"stop below", {"(d - $)*step(d - $)"}, {at}, kStates},
      {"step", {"step($ - d)"}, {at}, {}, ShapeTrait::shift},
      {"progressive stop above", {"($ - d)^2*step($ - d)"}, {at}, kStates},
      {"progressive stop below", {"(d - $)^2*step(d - $)"}, {at}, kStates},
      {"odd cubic", {"$", "$^3"}, {}, kSigned},
      {"approach", {"exp(-$/T)"}, {{"T", Sought::constant}}, kSlow},
      {"lag", {"lag($, T)"}, {{"T", Sought::constant}}, kStates},
      {"play", {"play($, w)"}, {width}, kHolding},
      {"loop", {"($ - play($, w))"}, {width}, kHolding},
      {"heat",
       {"lag($^2, T)"},
       {{"T", Sought::constant}},
       {SignalKind::torque},
       ShapeTrait::heating},
      {"cubic", {"$", "$^2", "$^3"}, {}, kStates},
      {"growth", {"exp($/w)"}, {width}, kForces},
      {"soft step", {"tanh(($ - d)/w)"}, {at, width}, kStates},
      {"bump", {"exp(-(($ - d)/w)^2)"}, {at, width}, kStates},
      {"catch", {"($ - d)*exp(-(($ - d)/w)^2)"}, {at, width}, kStates},
      {"wave of any order", {"sin(k*$)", "cos(k*$)"}, {{"k", Sought::wave}}, kAngles},
      {"two waves",
       {"sin($)", "cos($)", "sin(2*$)", "cos(2*$)"},
       {},
       kAngles,
       ShapeTrait::whole_waves},
      {"tone", {"sin(k*$)", "cos(k*$)"}, {{"k", Sought::wave}}, kSlow, ShapeTrait::tone}};
  const std::vector<Shape> waves = wave_shapes();
  all.insert(all.begin() + 7, waves.begin(), waves.end());
  return all;
}

std::string written(const std::string& term, const std::string& driver) {
  std::string text;
  for (const char each : term) {
    text += each == '$' ? driver : std::string(1, each);
  }
  return text;
}

double duration_of(const Observations& observations) {
  const Scene& scene = observations.scenes.front();
  return scene.time[scene.rows() - 1] - scene.time[0];
}

constexpr const char* kAnyDriver = "u";  // no parameter of a shape has this name

/// A term, written for `kAnyDriver`, along the rows of one scene.
void compute(const formula::Formula& formula, const Shape& shape, const Values& parameters,
             const Eigen::VectorXd& driver, const Eigen::VectorXd& time, bool is_static,
             Eigen::Ref<Eigen::VectorXd> course) {
  std::vector<double> values(formula.names().size(), 0);
  std::size_t at = values.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto known =
        std::find_if(shape.parameters.begin(), shape.parameters.end(),
                     [&](const ShapeParameter& each) { return formula.names()[i] == each.name; });
    if (known == shape.parameters.end()) {
      at = i;
    } else {
      values[i] = parameters[static_cast<std::size_t>(known - shape.parameters.begin())];
    }
  }
  formula::Course along(formula);
  for (Eigen::Index row = 0; row < course.size(); ++row) {
    if (at < values.size()) {
      values[at] = driver[row];
    }
    const bool is_timed = row > 0 && !is_static;
    course[row] = along.next(values, is_timed ? time[row] - time[row - 1] : 0);
  }
}

std::vector<double> starts_of(Sought sought, const Driver& driver, const Observations& observations,
                              double wave) {
  std::vector<double> starts;
  switch (sought) {
    case Sought::scale:
      for (const double share : {0.03, 0.1, 0.25, 0.5, 0.8}) {
        starts.push_back(share * driver.size());
      }
      break;
    case Sought::threshold:
      for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}) {
        starts.push_back(driver.low + share * driver.span());
      }
      break;
    case Sought::width:
      for (const double share : {0.03, 0.08, 0.2, 0.5}) {
        starts.push_back(share * driver.span());
      }
      break;
    case Sought::wave:
      starts.push_back(wave);
      break;
    case Sought::constant:
      for (double time = duration_of(observations); time > 0.005 * duration_of(observations);
           time /= 2) {
        starts.push_back(time);
      }
      break;
  }
  return starts;
}

Bounds bounds_of(Sought sought, const Driver& driver, const Observations& observations) {
  constexpr double kStep = 0.01;  // of what the parameter is relative to
  switch (sought) {
    case Sought::scale:
      return {1e-3 * driver.size(), 5 * driver.size(), kStep * driver.size()};
    case Sought::threshold:
      return {driver.low - driver.span(), driver.high + driver.span(), kStep * driver.span()};
    case Sought::width:
      return {1e-3 * driver.span(), 5 * driver.span(), kStep * driver.span()};
    case Sought::wave:
      return {0.1 / driver.span(), 1e4, 0.1 / driver.span()};
    case Sought::constant:
      break;
  }
  const double duration = duration_of(observations);
  return {1e-4 * duration, 10 * duration, kStep * duration};
}

}  // namespace

bool Shape::fits(const Seat& seat, const Driver& driver) const {
  const bool is_event = trait == ShapeTrait::tone || trait == ShapeTrait::shift;
  if (driver.kind == SignalKind::time && is_event != seat.is_sensor()) {
    return false;
  }
  if (driver.is_product && trait == ShapeTrait::heating) {
    return false;
  }
  if (driver.unit != "rad" && trait == ShapeTrait::whole_waves) {
    return false;
  }
  return suits(driver);
}

bool Shape::suits(const Driver& driver) const {
  return kinds.empty() || std::find(kinds.begin(), kinds.end(), driver.kind) != kinds.end();
}

bool Shape::remembers() const {
  return lags() || std::any_of(terms.begin(), terms.end(), [](const std::string& term) {
           return term.find("play(") != std::string::npos;
         });
}

bool Shape::lags() const {
  return std::any_of(terms.begin(), terms.end(), [](const std::string& term) {
    return term.find("lag(") != std::string::npos;
  });
}

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> kShapes = all_shapes();
  return kShapes;
}

const Shape& shape_named(std::string_view name) {
  return *std::find_if(shapes().begin(), shapes().end(),
                       [&](const Shape& each) { return each.name == name; });
}

const std::vector<Shape>& modulations() {
  static const std::vector<Shape> kModulations = {{"scale", {"1", "$"}, {}, {}},
                                                  {"swell", {"1", "$", "$^2"}, {}, {}},
                                                  {"turn", {"sin($)", "cos($)"}, {}, kAngles},
                                                  {"turn", {"sin(2*$)", "cos(2*$)"}, {}, kAngles},
                                                  {"turn", {"sin(3*$)", "cos(3*$)"}, {}, kAngles}};
  return kModulations;
}

std::vector<std::string> terms_of(const Shape& shape, const Driver& driver) {
  std::vector<std::string> terms;
  for (const std::string& term : shape.terms) {
    terms.push_back(written(term, driver.name));
  }
  return terms;
}

Eigen::MatrixXd courses_of(const Shape& shape, const Driver& driver, const Rows& rows,
                           const Observations& observations, const Values& parameters) {
  Eigen::MatrixXd courses(rows.count, static_cast<Eigen::Index>(shape.terms.size()));
  for (std::size_t i = 0; i < shape.terms.size(); ++i) {
    const formula::Formula formula(written(shape.terms[i], kAnyDriver));
    for (std::size_t scene = 0; scene < observations.scenes.size(); ++scene) {
      const Eigen::Index first = rows.first[scene];
      const Eigen::Index count = rows.rows(scene);
      compute(formula, shape, parameters, driver.course.segment(first, count),
              rows.time.segment(first, count), observations.is_static,
              courses.col(static_cast<Eigen::Index>(i)).segment(first, count));
    }
  }
  return courses;
}

double span_of_input(const Shape& shape, const Driver& driver) {
  return shape.trait == ShapeTrait::heating ? driver.size() * driver.size() : driver.span();
}

std::vector<Bounds> bounds_of(const Shape& shape, const Driver& driver,
                              const Observations& observations) {
  std::vector<Bounds> bounds;
  for (const ShapeParameter& each : shape.parameters) {
    bounds.push_back(bounds_of(each.sought, driver, observations));
  }
  return bounds;
}

std::vector<Values> starts_of(const Shape& shape, const Driver& driver,
                              const Observations& observations, double wave) {
  std::vector<Values> starts = {{}};
  for (const ShapeParameter& each : shape.parameters) {
    std::vector<Values> grown;
    for (const Values& start : starts) {
      for (const double value : starts_of(each.sought, driver, observations, wave)) {
        grown.push_back(start);
        grown.back().push_back(value);
      }
    }
    starts = std::move(grown);
  }
  return starts;
}

}  // namespace flexcomp::diagnosis::grammar
