#include "localization/filter/arrival_jitter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lodestar {
namespace {

// Of the newest reading. Chosen by hand: a period is known for long, a jitter begins within a fifth of a
// second.
constexpr double period_weight = 0.01;
constexpr double shortfall_weight = 0.1;

}  // namespace

void ArrivalJitter::add(Stamp arrived) {
  const std::optional<Stamp> before = std::exchange(last_, arrived);
  if (!before) return;
  const double interval_s = seconds(arrived - *before);
  if (period_s_ == 0.0) period_s_ = interval_s;
  const double shortfall_s = std::max(0.0, period_s_ - interval_s);
  period_s_ += period_weight * (interval_s - period_s_);
  shortfall_squared_ += shortfall_weight * (shortfall_s * shortfall_s - shortfall_squared_);
}

/// Two independent delays make an interval, of which the half that is short is counted: the mean square of
/// small jitter as it is. Where readings overtake each other, an interval is short by half of the truth.
double ArrivalJitter::sigma_s() const {
  return std::sqrt(2.0 * shortfall_squared_);
}

}  // namespace lodestar
