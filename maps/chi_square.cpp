#include "maps/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace lodestar {

double chi_square_quantile(double probability, double degrees_of_freedom) {
  return boost::math::quantile(boost::math::chi_squared(degrees_of_freedom), probability);
}

}  // namespace lodestar
