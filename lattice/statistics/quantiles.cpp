// SPDX-License-Identifier: MIT
#include "lattice/statistics/quantiles.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace gatewalk::lattice {

double chi_squared_exceeded(double degrees, double chance) {
  return boost::math::quantile(boost::math::complement(boost::math::chi_squared(degrees), chance));
}

double student_t_975(double degrees) {
  return boost::math::quantile(boost::math::students_t(degrees), 0.975);
}

}  // namespace gatewalk::lattice
