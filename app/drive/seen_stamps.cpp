#include "app/drive/seen_stamps.hpp"

namespace lodestar {

void SeenStamps::take(Stamp stamp, Stamp arrival) {
  ++count;
  if (!first) first = stamp;
  last = stamp;
  ages += arrival - stamp;
}

std::optional<double> SeenStamps::rate_hz() const {
  if (count < 2 || last <= *first) return std::nullopt;
  return (count - 1) / seconds(last - *first);
}

double SeenStamps::mean_age_s() const {
  return count == 0 ? 0.0 : seconds(ages) / count;
}

}  // namespace lodestar
