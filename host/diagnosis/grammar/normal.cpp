#include "diagnosis/grammar/normal.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace flexcomp::diagnosis::grammar {
namespace {

/// Divisions; 20 of them are most of them (compose.cpp), which by chance one in a thousand shows.
constexpr int kHalves = 24;

/// Stretches that hold samples to fit to, in a random order that is the same every time.
std::vector<std::size_t> shuffled(const std::vector<Normal>& by_stretch, std::mt19937* random) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < by_stretch.size(); ++i) {
    if (by_stretch[i].gram.diagonal().sum() > 0) {
      order.push_back(i);
    }
  }
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[(*random)() % i]);
  }
  return order;
}

Normal sum_of(const std::vector<Normal>& by_stretch, const std::vector<std::size_t>& which,
              std::size_t begin, std::size_t end) {
  Normal sum = by_stretch.front();
  sum.gram.setZero();
  sum.moment.setZero();
  for (std::size_t i = begin; i < end; ++i) {
    sum.gram += by_stretch[which[i]].gram;
    sum.moment += by_stretch[which[i]].moment;
  }
  return sum;
}

}  // namespace

Eigen::VectorXd Normal::amplitude() const {
  constexpr double kTiny = 1e-300;  // against a division by zero
  const Eigen::VectorXd scale = gram.diagonal().cwiseMax(kTiny).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  constexpr double kIndependent = 1e-8;  // of a square: keeps terms that are one solvable
  scaled.diagonal().array() += kIndependent;
  return scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * moment);
}

double Normal::gain(const Eigen::VectorXd& amplitude) const {
  return 2 * moment.dot(amplitude) - amplitude.dot(gram * amplitude);
}

Normal beside(Eigen::MatrixXd gram, const Eigen::MatrixXd& shown, Eigen::VectorXd moment) {
  const Eigen::VectorXd least = kApart * gram.diagonal();
  gram -= shown.transpose() * shown;
  gram.diagonal() += least;
  return {std::move(gram), std::move(moment)};
}

Normal normal_of(const Seat& seat, const Eigen::MatrixXd& courses) {
  const Eigen::MatrixXd shown = seat.fitted.transpose() * courses;
  return beside(courses.transpose() * seat.weight.asDiagonal() * courses, shown,
                courses.transpose() * seat.product);
}

std::vector<Normal> normals_by_stretch(const Seat& seat, const Rows& rows,
                                       const Eigen::MatrixXd& courses) {
  const Eigen::Index terms = courses.cols();
  std::vector<Normal> all(static_cast<std::size_t>(rows.stretches),
                          {Eigen::MatrixXd::Zero(terms, terms), Eigen::VectorXd::Zero(terms)});
  for (Eigen::Index row = 0; row < rows.count; ++row) {
    if (seat.weight[row] > 0) {
      Normal& own = all[static_cast<std::size_t>(rows.stretch[static_cast<std::size_t>(row)])];
      const Eigen::VectorXd course = courses.row(row).transpose();
      own.gram.noalias() += seat.weight[row] * course * course.transpose();
      own.moment += seat.product[row] * course;
    }
  }
  return all;
}

std::vector<double> unseen_gains(const std::vector<Normal>& by_stretch) {
  std::mt19937 random(1);
  std::vector<double> gains;
  for (int i = 0; i < kHalves; ++i) {
    const std::vector<std::size_t> order = shuffled(by_stretch, &random);
    const std::size_t half = order.size() / 2;
    const Normal seen = sum_of(by_stretch, order, 0, half);
    const Normal unseen = sum_of(by_stretch, order, half, order.size());
    gains.push_back(unseen.gain(seen.amplitude()));
  }
  return gains;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

}  // namespace flexcomp::diagnosis::grammar
