#pragma once

#include <optional>

#include "maps/stamp.hpp"

namespace lodestar {

/// When what a sensor delivers was measured, and when it arrived.
struct SeenStamps {
  void take(Stamp stamp, Stamp arrival);
  /// By the stamps; nothing before the second.
  [[nodiscard]] std::optional<double> rate_hz() const;
  /// At arrival; zero where nothing came.
  [[nodiscard]] double mean_age_s() const;

  int count = 0;
  std::optional<Stamp> first;
  Stamp last;
  Duration ages{};  ///< at arrival, in sum
};

}  // namespace lodestar
