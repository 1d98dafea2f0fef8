#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

// Whether the errors of our poses are as large as their covariances say.
namespace lodestar {

/// Normalized squared errors e^T P^-1 e of the poses from many rendered frames. Where P is true their mean is
/// the number of degrees of freedom, and lies within these bounds in 95 of 100 campaigns (chi-square).
struct Consistency {
  std::string conditions;
  int frames = 0;
  int poses = 0;
  int degrees_of_freedom = 0;
  double mean_nees = 0.0;

  [[nodiscard]] double per_degree() const { return mean_nees / degrees_of_freedom; }
  [[nodiscard]] double half_band_per_degree() const;  ///< about 1
};

/// One for each of several conditions, of so many frames each, in all cores. Equal seeds give equal results.
/// `done` hears of frames done, from any thread.
std::vector<Consistency> measure_consistency(int frames, std::uint64_t seed,
                                             const std::function<void(int frames)>& done);

/// How many conditions there are.
std::size_t consistency_conditions();

}  // namespace lodestar
