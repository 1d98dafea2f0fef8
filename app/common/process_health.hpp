#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

// Health of a process that is to run for weeks: memory, open descriptors, step times.
namespace lodestar {

struct ProcessHealth {
  std::int64_t resident_kb = 0;
  int descriptors = 0;
};

/// Of this process, from /proc; zeros where there is none.
ProcessHealth process_health();

/// A histogram of times in constant memory: 80 bins a decade from 1 microsecond to 10 seconds, hence exact to
/// 3 %.
class TimeHistogram {
 public:
  void add(std::chrono::nanoseconds time);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double max_ms() const { return max_ms_; }
  /// The time that this share of the samples did not exceed; nothing without samples.
  [[nodiscard]] std::optional<double> quantile_ms(double share) const;

 private:
  static constexpr int steps_per_decade = 80;
  static constexpr int decades = 7;
  std::array<std::uint64_t, steps_per_decade * decades> bins_{};
  std::uint64_t count_ = 0;
  double max_ms_ = 0.0;
};

}  // namespace lodestar
