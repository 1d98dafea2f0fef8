#pragma once

#include <optional>

#include "maps/stamp.hpp"

namespace lodestar {

/// How unevenly late the wheels' readings arrive. A base sends them at a fixed period, and they are stamped
/// on arrival: one that comes early was followed by a late one, or was late itself. Intervals longer than the
/// period say nothing, as a reading may have been lost. A value type.
class ArrivalJitter {
 public:
  void add(Stamp arrived);

  /// Standard deviation of the readings' delay about its mean.
  [[nodiscard]] double sigma_s() const;

 private:
  std::optional<Stamp> last_;
  double period_s_ = 0.0;           ///< the mean interval; zero before the first
  double shortfall_squared_ = 0.0;  ///< mean square, in seconds
};

}  // namespace lodestar
