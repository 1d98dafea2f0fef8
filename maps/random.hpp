#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace lodestar {

/// Random numbers that are the same on every machine and library: splitmix64 (Steele, Lea and Flood 2014),
/// with the distributions written out. The caller that chooses a seed prints it.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }

  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// In [0, count).
  std::uint64_t below(std::uint64_t count) { return bits() % count; }

  /// Gaussian with mean 0 and deviation 1 (Box and Muller 1958; one value a call, so that the order of calls
  /// is all that decides the values).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

  /// A separate stream for one purpose, so that additional draws here do not change the values there.
  [[nodiscard]] Random stream(std::uint64_t purpose) const {
    return Random(Random(state_ ^ (purpose * 0xd1342543de82ef95ULL)).bits());
  }

 private:
  std::uint64_t state_;
};

}  // namespace lodestar
