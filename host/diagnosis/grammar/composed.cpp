#include "diagnosis/grammar/composed.hpp"

#include <algorithm>
#include <cmath>

namespace flexcomp::diagnosis::grammar {
namespace {

constexpr int kRefinements = 5;  // halvings of the step around the best start

/// A form of a lead along all rows, by its parameters.
class Fitted {
 public:
  Fitted(const Material& material, const Lead& lead, const Form& form)
      : observations_(material.observations), rows_(material.rows), lead_(lead), form_(form) {}

  /// The terms, a constant where the form has one, and last what a beginning leaves behind.
  Eigen::MatrixXd courses(const Values& parameters) const {
    Eigen::MatrixXd courses =
        courses_of(*form_.shape, *lead_.driver, rows_, observations_, parameters);
    const auto append = [&](const Eigen::VectorXd& course) {
      courses.conservativeResize(Eigen::NoChange, courses.cols() + 1);
      courses.rightCols<1>() = course;
    };
    if (form_.has_constant) {
      append(Eigen::VectorXd::Ones(courses.rows()));
    }
    if (has_beginning()) {
      append((-(rows_.time.array() - rows_.time[0]) / parameters.front()).exp());
    }
    if (lead_.factor.course.size() > 0) {
      courses.array().colwise() *= lead_.factor.course.array();
    }
    return form_.modulation.driver == nullptr ? courses : modulated(courses);
  }

  /// What lags remembers loads that nobody recorded, unless there are several recordings, which
  /// began each elsewhere.
  bool has_beginning() const {
    return form_.shape->lags() && form_.modulation.driver == nullptr && !observations_.is_static &&
           observations_.train_scenes == 1;
  }

  double gain(const Values& parameters) const {
    const Eigen::MatrixXd all = courses(parameters);
    if (!all.allFinite()) {
      return 0;
    }
    const Normal normal = normal_of(*lead_.seat, all);
    return normal.gain(normal.amplitude());
  }

  /// The best parameters: the best start, and around it in ever smaller steps.
  Values best() const {
    const std::vector<Values> starts =
        starts_of(*form_.shape, *lead_.driver, observations_, lead_.wave);
    Values best = starts.front();
    double most = -1;
    for (const Values& start : starts) {
      const double own = starts.size() > 1 ? gain(start) : 0;
      if (own > most) {
        most = own;
        best = start;
      }
    }
    return refined(std::move(best), most);
  }

 private:
  /// Each course times each of what the second driver does.
  Eigen::MatrixXd modulated(const Eigen::MatrixXd& courses) const {
    const Eigen::MatrixXd by =
        courses_of(*form_.modulation.shape, *form_.modulation.driver, rows_, observations_, {});
    Eigen::MatrixXd all(courses.rows(), courses.cols() * by.cols());
    for (Eigen::Index i = 0; i < courses.cols(); ++i) {
      all.middleCols(i * by.cols(), by.cols()) = by.array().colwise() * courses.col(i).array();
    }
    return all;
  }

  Values refined(Values best, double most) const {
    const std::vector<Bounds> bounds = bounds_of(*form_.shape, *lead_.driver, observations_);
    for (std::size_t i = 0; i < best.size(); ++i) {
      const bool is_place = form_.shape->parameters[i].sought == Sought::threshold ||
                            form_.shape->parameters[i].sought == Sought::wave;
      double step = is_place ? bounds[i].step * 5 : 0.4 * best[i];
      for (int k = 0; k < kRefinements; ++k, step /= 2) {
        for (const double change : {-step, step}) {
          Values moved = best;
          moved[i] = std::clamp(moved[i] + change, bounds[i].lower, bounds[i].upper);
          const double own = gain(moved);
          if (own > most) {
            most = own;
            best = std::move(moved);
          }
        }
      }
    }
    return best;
  }

  const Observations& observations_;
  const Rows& rows_;
  const Lead& lead_;
  Form form_;
};

/// Each term's amplitude by which it changes the samples as much as the largest term does.
Eigen::VectorXd reach_of(const Normal& normal, const Eigen::VectorXd& amplitude) {
  constexpr double kTiny = 1e-300;  // against a division by zero
  const Eigen::VectorXd size = normal.gram.diagonal().cwiseMax(kTiny).cwiseSqrt();
  return amplitude.cwiseAbs().cwiseProduct(size).maxCoeff() * size.cwiseInverse();
}

/// Gives the first term the beginning that fits best, by the last course, which goes: by how much
/// what lags begins above its input, no more than the input ever changes. Halves that lack the
/// first rows could not tell.
double take_beginning(const Seat& seat, double span, Eigen::MatrixXd* courses) {
  const Eigen::VectorXd amplitude = normal_of(seat, *courses).amplitude();
  const double ahead = amplitude[amplitude.size() - 1] / amplitude[0];
  const double beginning = std::isfinite(ahead) ? std::clamp(ahead, -span, span) : 0;
  courses->col(0) += beginning * courses->col(courses->cols() - 1);
  courses->conservativeResize(Eigen::NoChange, courses->cols() - 1);
  return beginning;
}

}  // namespace

Values best_parameters(const Material& material, const Lead& lead, const Form& form) {
  return Fitted(material, lead, form).best();
}

double gain_of(const Material& material, const Lead& lead, const Form& form,
               const Values& parameters) {
  return Fitted(material, lead, form).gain(parameters);
}

Composed composed_of(const Material& material, const Lead& lead, const Form& form,
                     Values parameters) {
  Composed law{lead, form, std::move(parameters), {}, {}, {}, 0, {}, nullptr};
  const Fitted fitted(material, lead, form);
  Eigen::MatrixXd courses = fitted.courses(law.parameters);
  if (!courses.allFinite()) {
    return law;
  }
  if (fitted.has_beginning()) {
    law.beginning = take_beginning(*lead.seat, span_of_input(*form.shape, *lead.driver), &courses);
  }
  const Normal normal = normal_of(*lead.seat, courses);
  law.amplitude = normal.amplitude();
  law.reach = reach_of(normal, law.amplitude);
  law.gain = normal.gain(law.amplitude);
  law.unseen = unseen_gains(normals_by_stretch(*lead.seat, material.rows, courses));
  return law;
}

Composed without_constant(const Material& material, const Composed& law) {
  return composed_of(material, law.lead, {law.form.shape, false, {}}, law.parameters);
}

}  // namespace flexcomp::diagnosis::grammar
