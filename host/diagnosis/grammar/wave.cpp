#include "diagnosis/grammar/wave.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "statistics/median.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

/// Periods a turn, chosen by judgement: time against waves finer than the hundred or so teeth of a
/// gear wheel. The waves of strain-wave gears are in the catalogue.
constexpr double kMostOrder = 150;
constexpr double kLeastPeriods = 1;  // along the driver: less of a wave is a bend
constexpr double kSpacing = 1.5;  // rad of phase over the driver between orders tried: a quarter of
                                  // the way from a peak to its first zero

/// Sums of a seat's rows for one order after another: the phases turn by a constant angle. The wave
/// has a size of so many terms in each row.
template <int Terms>
class Periodogram {
 public:
  using Size = Eigen::Matrix<double, Terms, 1>;

  template <typename SizeOf>
  Periodogram(const Seat& seat, const Driver& driver, double first, double spacing,
              SizeOf size_of) {
    for (Eigen::Index row = 0; row < seat.weight.size(); ++row) {
      if (seat.weight[row] > 0) {
        size_.push_back(size_of(row));
        weight_.push_back(seat.weight[row]);
        product_.push_back(seat.product[row]);
        phase_.push_back(std::polar(1.0, first * driver.course[row]));
        turn_.push_back(std::polar(1.0, spacing * driver.course[row]));
      }
    }
  }

  double gain() const {
    constexpr int kConstant = 2 * Terms;
    using Basis = Eigen::Matrix<double, kConstant + 1, 1>;
    Eigen::Matrix<double, kConstant + 1, kConstant + 1> gram;
    gram.setZero();
    Basis moment = Basis::Zero();
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      Basis basis;
      basis << phase_[i].imag() * size_[i], phase_[i].real() * size_[i], 1;
      gram += weight_[i] * basis * basis.transpose();
      moment += product_[i] * basis;
    }
    constexpr double kIndependent = 1e-6;  // of a square: keeps a nearly constant wave solvable
    gram.diagonal() *= 1 + kIndependent;
    const double constant = moment[kConstant] * moment[kConstant] / gram(kConstant, kConstant);
    return moment.dot(gram.ldlt().solve(moment)) - constant;
  }

  void advance() {
    for (std::size_t i = 0; i < phase_.size(); ++i) {
      phase_[i] *= turn_[i];
    }
  }

 private:
  std::vector<double> weight_;
  std::vector<double> product_;
  std::vector<Size, Eigen::aligned_allocator<Size>> size_;
  std::vector<std::complex<double>> phase_;
  std::vector<std::complex<double>> turn_;
};

/// Time between samples, in most cases: recordings that follow each other begin at times of their
/// own.
double time_step(const Driver& time) {
  std::vector<double> steps;
  for (Eigen::Index row = 1; row < time.course.size(); ++row) {
    const double step = time.course[row] - time.course[row - 1];
    if (step > 0) {
      steps.push_back(step);
    }
  }
  return statistics::median(std::move(steps));
}

/// The wave of any order that gains most.
template <int Terms, typename SizeOf>
Wave best_of_orders(const Seat& seat, const Driver& driver, SizeOf size_of) {
  const double first = 2 * M_PI * kLeastPeriods / driver.span();
  const double spacing = kSpacing / driver.span();
  const bool is_time = driver.kind == effects::SignalKind::time;
  const double last = is_time ? M_PI / time_step(driver) : kMostOrder;
  Wave best;
  Periodogram<Terms> along(seat, driver, first, spacing, size_of);
  for (double order = first; order < last; order += spacing) {
    const double gain = along.gain();
    if (gain > best.gain) {
      best = {order, gain};
    }
    along.advance();
  }
  return best;
}

}  // namespace

Wave best_wave(const Seat& seat, const Driver& driver) {
  using Size = Eigen::Matrix<double, 1, 1>;
  return best_of_orders<1>(seat, driver, [](Eigen::Index) { return Size(1); });
}

Wave best_swelling_wave(const Seat& seat, const Driver& driver, const Driver& by) {
  return best_of_orders<3>(seat, driver, [&](Eigen::Index row) {
    const double along = 2 * (by.course[row] - by.low) / by.span() - 1;
    return Eigen::Vector3d(1, along, along * along);
  });
}

double best_step(const Seat& seat) {
  const double weight = seat.weight.sum();
  const double product = seat.product.sum();
  double before = 0;
  double shown = 0;
  double most = 0;
  for (Eigen::Index row = 0; row < seat.weight.size(); ++row) {
    before += seat.weight[row];
    shown += seat.product[row];
    if (before > 0 && before < weight) {
      const double after = weight - before;
      most = std::max(most, shown * shown / before + (product - shown) * (product - shown) / after -
                                product * product / weight);
    }
  }
  return most;
}

}  // namespace flexcomp::diagnosis::grammar
