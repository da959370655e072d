#include "control/fuzzy.hpp"

#include <array>
#include <cmath>

#include "error.hpp"

namespace flexcomp::control {
namespace {

constexpr std::array<double, 2> kGaussNodes = {0.33998104358485626, 0.86113631159405258};
constexpr std::array<double, 2> kGaussWeights = {0.65214515486254614, 0.34785484513745386};

/// Value at which a line through two points of the membership reaches a degree.
double crossing(const std::pair<double, double>& a, const std::pair<double, double>& b,
                double degree) {
  return a.first + (degree - a.second) / (b.second - a.second) * (b.first - a.first);
}

void refuse_disorder(const std::vector<std::pair<double, double>>& points) {
  bool fine = points.size() >= 2;
  bool falling = false;
  double highest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [value, degree] = points[i];
    fine = fine && std::isfinite(value) && degree >= 0 && degree <= 1;
    highest = std::max(highest, degree);
    if (i > 0) {
      fine = fine && value > points[i - 1].first;
      fine = fine && !(falling && degree > points[i - 1].second);
      falling = falling || degree < points[i - 1].second;
    }
  }
  if (!fine || highest < 1) {
    throw InputError(
        "a tabulated fuzzy number needs increasing values with degrees that rise to 1 and fall");
  }
}

}  // namespace

auto FuzzyNumber::levels() -> const Cuts& {
  static const Cuts levels = [] {
    Cuts made;
    made[0] = 0;
    for (int i = 0; i < kCuts; ++i) {
      const auto node = static_cast<std::size_t>(i % 2);
      const double side = i % kNodes < 2 ? -1 : 1;
      const int panel = i / kNodes;
      made[i + 1] = (panel + 0.5 + side * kGaussNodes[node] / 2) / kPanels;
    }
    return made;
  }();
  return levels;
}

auto FuzzyNumber::weights() -> const Cuts& {
  static const Cuts weights = [] {
    Cuts made;
    made[0] = 0;
    for (int i = 0; i < kCuts; ++i) {
      made[i + 1] = kGaussWeights[static_cast<std::size_t>(i % 2)] / (2 * kPanels);
    }
    return made;
  }();
  return weights;
}

FuzzyNumber FuzzyNumber::crisp(double value) { return trapezoidal(value, value, value, value); }

FuzzyNumber FuzzyNumber::triangular(double lower, double mode, double upper) {
  return trapezoidal(lower, mode, mode, upper);
}

FuzzyNumber FuzzyNumber::trapezoidal(double lower, double first, double last, double upper) {
  if (!(lower <= first && first <= last && last <= upper) || !std::isfinite(upper - lower)) {
    throw InputError("the corners of a fuzzy number must be finite and in order");
  }
  FuzzyNumber number;
  number.lower_ = lower + (first - lower) * levels();
  number.upper_ = upper - (upper - last) * levels();
  return number;
}

FuzzyNumber FuzzyNumber::tabulated(const std::vector<std::pair<double, double>>& points) {
  refuse_disorder(points);
  FuzzyNumber number;
  for (Eigen::Index i = 0; i <= kCuts; ++i) {
    const double level = levels()[i];
    std::size_t first = 0;
    // At level zero the cut is the closure: all that belongs to any degree above zero.
    while (points[first].second < level ||
           (level == 0 && points[first].second == 0 && points[first + 1].second == 0)) {
      ++first;
    }
    std::size_t last = points.size() - 1;
    while (points[last].second < level ||
           (level == 0 && points[last].second == 0 && points[last - 1].second == 0)) {
      --last;
    }
    number.lower_[i] = first > 0 && points[first].second > level
                           ? crossing(points[first - 1], points[first], level)
                           : points[first].first;
    number.upper_[i] = last + 1 < points.size() && points[last].second > level
                           ? crossing(points[last + 1], points[last], level)
                           : points[last].first;
  }
  return number;
}

FuzzyNumber FuzzyNumber::operator+(const FuzzyNumber& other) const {
  FuzzyNumber sum;
  sum.lower_ = lower_ + other.lower_;
  sum.upper_ = upper_ + other.upper_;
  return sum;
}

FuzzyNumber FuzzyNumber::operator-(const FuzzyNumber& other) const { return *this + other * -1; }

FuzzyNumber FuzzyNumber::operator*(const FuzzyNumber& other) const {
  FuzzyNumber product;
  const Cuts low = (lower_ * other.lower_).min(lower_ * other.upper_);
  const Cuts high = (lower_ * other.lower_).max(lower_ * other.upper_);
  product.lower_ = low.min((upper_ * other.lower_).min(upper_ * other.upper_));
  product.upper_ = high.max((upper_ * other.lower_).max(upper_ * other.upper_));
  return product;
}

FuzzyNumber FuzzyNumber::operator*(double factor) const {
  FuzzyNumber scaled;
  scaled.lower_ = (factor * lower_).min(factor * upper_);
  scaled.upper_ = (factor * lower_).max(factor * upper_);
  return scaled;
}

FuzzyNumber FuzzyNumber::squared() const {
  FuzzyNumber size = magnitude();
  size.lower_ = size.lower_.square();
  size.upper_ = size.upper_.square();
  return size;
}

FuzzyNumber FuzzyNumber::magnitude() const {
  FuzzyNumber size;
  size.lower_ = lower_.max(-upper_).max(0.0);
  size.upper_ = upper_.max(-lower_);
  return size;
}

/// ∫ν^k μ dν = ∫(U^(k+1) − L^(k+1))/(k+1) dα, with the width U − L taken out of the difference.
double FuzzyNumber::mean_of_power(int power) const {
  const Cuts width = upper_ - lower_;
  const double area = (weights() * width).sum();
  const Cuts mean = power == 1 ? Cuts((upper_ + lower_) / 2)
                               : Cuts((upper_.square() + upper_ * lower_ + lower_.square()) / 3);
  return area > 0 ? (weights() * width * mean).sum() / area : mean[kCuts];
}

double FuzzyNumber::mean() const { return mean_of_power(1); }

double FuzzyNumber::mean_square() const { return mean_of_power(2); }

}  // namespace flexcomp::control
