#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

// What a process that shall run for weeks is watched for.
namespace lodestar {

struct ProcessHealth {
  std::int64_t resident_kb = 0;
  int descriptors = 0;
};

/// Of this process, from /proc; zeros where there is none.
ProcessHealth process_health();

/// A histogram of times that takes no memory as it fills: eighty steps to the decade, from a microsecond to
/// ten seconds, hence exact to 3 %.
class TimeHistogram {
 public:
  void add(std::chrono::nanoseconds time);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double max_ms() const { return max_ms_; }
  /// The time that this share of all did not exceed; nothing when there were none.
  [[nodiscard]] std::optional<double> quantile_ms(double share) const;

 private:
  static constexpr int steps_per_decade = 80;
  static constexpr int decades = 7;
  std::array<std::uint64_t, steps_per_decade * decades> bins_{};
  std::uint64_t count_ = 0;
  double max_ms_ = 0.0;
};

}  // namespace lodestar
