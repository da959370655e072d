#include "diagnosis/search/tried_law.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "effects/formula_law.hpp"
#include "error.hpp"
#include "files/one_line.hpp"
#include "model/yaml_map.hpp"

namespace flexcomp::diagnosis {
namespace {

using model::YamlMap;

constexpr std::array<int, 12> kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};

struct SoughtRange {
  double lower = 0;
  double upper = 0;
};

std::map<std::string, SoughtRange> read_ranges(const YamlMap& yaml) {
  std::map<std::string, SoughtRange> ranges;
  if (!yaml.has("ranges")) {
    return ranges;
  }
  const YamlMap map = yaml.map("ranges");
  for (const std::string& name : map.keys()) {
    const std::array<double, 2> bounds = map.numbers<2>(name);
    if (!(bounds[0] < bounds[1])) {
      map.refuse(name, "expected a lower and a higher bound");
    }
    ranges[name] = {bounds[0], bounds[1]};
  }
  return ranges;
}

/// The sequence of Halton (1960), whose points lie evenly in any number of dimensions: its
/// `index`th number to a base, in 0…1.
double halton(int index, int base) {
  double value = 0;
  double share = 1;
  for (int rest = index; rest > 0; rest /= base) {
    share /= base;
    value += share * (rest % base);
  }
  return value;
}

/// Evenly within the bounds, or over their powers of ten where they span several above zero.
double between(const SoughtRange& range, double share) {
  constexpr double kDecades = 100;  // times: over two decades even steps leave out the lower one
  return range.lower > 0 && range.upper > kDecades * range.lower
             ? range.lower * std::pow(range.upper / range.lower, share)
             : range.lower + share * (range.upper - range.lower);
}

/// Starts all over the ranges of those parameters that do not act in proportion.
std::vector<Values> starts_within(const std::vector<SoughtRange>& ranges) {
  constexpr std::array<int, 4> kStarts = {1, 16, 48, 96};
  const int count = kStarts[std::min(ranges.size(), kStarts.size() - 1)];
  std::vector<Values> starts;
  for (int i = 1; i <= count; ++i) {
    Values start;
    for (std::size_t k = 0; k < ranges.size(); ++k) {
      start.push_back(between(ranges[k], halton(i, kPrimes[k])));
    }
    starts.push_back(std::move(start));
  }
  return starts;
}

void seek_within(const YamlMap& yaml, std::map<std::string, SoughtRange> ranges,
                 Hypothesis* hypothesis) {
  constexpr double kStep = 0.01;  // of a range
  std::vector<Bounds> bounds;
  std::vector<SoughtRange> shapes;
  for (std::size_t i = 0; i < hypothesis->parameters.size(); ++i) {
    const std::string& name = hypothesis->parameters[i].name;
    const SoughtRange range = ranges.at(name);
    if (i < hypothesis->linear && !(range.lower <= 0 && range.upper >= 0)) {
      yaml.refuse("ranges", fmt::format("{} acts in proportion; expected a range that holds 0",
                                        files::one_line(name)));
    }
    if (i >= hypothesis->linear) {
      shapes.push_back(range);
    }
    bounds.push_back({range.lower, range.upper, kStep * (range.upper - range.lower)});
  }
  hypothesis->set_bounds(bounds);
  hypothesis->starts = starts_within(shapes);
}

void refuse_unseen(const effects::BoundFormula& bound, const Observations& observations) {
  for (const Scene& scene : observations.scenes) {
    if (bound.follows(effects::SignalKind::temperature) && scene.temperature.size() == 0) {
      throw InputError(fmt::format("{}: follows temp_c, which {} does not have",
                                   bound.written.where.at("formula"), scene.file));
    }
  }
}

}  // namespace

Hypothesis read_tried_law(const std::filesystem::path& file, const Observations& observations) {
  const YamlMap yaml = model::load_yaml(file);
  yaml.allow_only({"effect", "place", "joint", "axis", "formula", "units", "ranges"});
  if (yaml.has("effect") && yaml.text("effect") != model::kLaw) {
    yaml.refuse("effect", fmt::format("expected {}", model::kLaw));
  }
  const model::Robot& robot = observations.machine.robot;
  const int joint = model::read_joint_number(yaml, robot.joints());
  const std::map<std::string, SoughtRange> ranges = read_ranges(yaml);
  std::vector<std::string> names;
  for (const auto& [name, range] : ranges) {
    names.push_back(name);
  }
  const auto bound = std::make_shared<const effects::BoundFormula>(
      effects::bind_law(model::read_written_law(yaml), robot, joint, names));
  if (bound->parameters.empty()) {
    yaml.refuse("formula",
                "has no parameter to be sought; give one or more a range under 'ranges'");
  }
  refuse_unseen(*bound, observations);
  Hypothesis hypothesis(effects::formula_law(bound, effects::Unvalued::not_a_number), joint, robot);
  seek_within(yaml, ranges, &hypothesis);
  return hypothesis;
}

}  // namespace flexcomp::diagnosis
