#include "diagnosis/grammar/wave.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

namespace flexcomp::diagnosis::grammar {
namespace {

/// Periods a turn, chosen by judgement: time against waves finer than the hundred or so teeth of a
/// gear wheel. The waves of strain-wave gears are in the catalogue.
constexpr double kMostOrder = 150;
constexpr double kLeastPeriods = 1;  // along the driver: less of a wave is a bend
constexpr double kSpacing = 1.5;  // rad of phase over the driver between orders tried: a quarter of
                                  // the way from a peak to its first zero

/// Sums of a seat's rows for one order after another: the phases turn by a constant angle.
class Periodogram {
 public:
  Periodogram(const Seat& seat, const Driver& driver, double first, double spacing) {
    for (Eigen::Index row = 0; row < seat.weight.size(); ++row) {
      if (seat.weight[row] > 0) {
        weight_.push_back(seat.weight[row]);
        product_.push_back(seat.product[row]);
        phase_.push_back(std::polar(1.0, first * driver.course[row]));
        turn_.push_back(std::polar(1.0, spacing * driver.course[row]));
      }
    }
  }

  double gain() const {
    Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      const Eigen::Vector3d basis(phase_[i].imag(), phase_[i].real(), 1);
      gram += weight_[i] * basis * basis.transpose();
      moment += product_[i] * basis;
    }
    constexpr double kIndependent = 1e-6;  // of a square: keeps a nearly constant wave solvable
    gram.diagonal() *= 1 + kIndependent;
    return moment.dot(gram.ldlt().solve(moment)) - moment[2] * moment[2] / gram(2, 2);
  }

  void advance() {
    for (std::size_t i = 0; i < phase_.size(); ++i) {
      phase_[i] *= turn_[i];
    }
  }

 private:
  std::vector<double> weight_;
  std::vector<double> product_;
  std::vector<std::complex<double>> phase_;
  std::vector<std::complex<double>> turn_;
};

}  // namespace

Wave best_wave(const Seat& seat, const Driver& driver) {
  const double first = 2 * M_PI * kLeastPeriods / driver.span();
  const double spacing = kSpacing / driver.span();
  const auto rows = static_cast<double>(seat.weight.size());
  const double last =
      driver.kind == effects::SignalKind::time ? M_PI * rows / driver.span() : kMostOrder;
  Wave best;
  Periodogram along(seat, driver, first, spacing);
  for (double order = first; order < last; order += spacing) {
    const double gain = along.gain();
    if (gain > best.gain) {
      best = {order, gain};
    }
    along.advance();
  }
  return best;
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
