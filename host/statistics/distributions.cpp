#include "statistics/distributions.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace flexcomp::statistics {

double chi_squared_above(double value, double freedom) {
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), value));
}

double fisher_above(double value, double more, double left) {
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(more, left), value));
}

double normal_above(double value) {
  return boost::math::cdf(boost::math::complement(boost::math::normal(), value));
}

double student_exceeds(double chance, double freedom) {
  return boost::math::quantile(boost::math::complement(boost::math::students_t(freedom), chance));
}

}  // namespace flexcomp::statistics
