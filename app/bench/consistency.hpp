#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

// Consistency of our pose fixes: whether their errors match their covariances.
namespace lodestar {

/// Normalized squared errors e^T P^-1 e of the poses from many rendered frames. For a correct P their mean is
/// the number of degrees of freedom, within these bounds with 95 % probability (chi-square).
struct Consistency {
  std::string conditions;
  int frames = 0;
  int poses = 0;
  int degrees_of_freedom = 0;
  double mean_nees = 0.0;

  [[nodiscard]] double per_degree() const { return mean_nees / degrees_of_freedom; }
  [[nodiscard]] double half_band_per_degree() const;  ///< about 1
};

/// One result per condition, from `frames` frames each, on all cores. Equal seeds give equal results. `done`
/// is called with the number of frames done, from any thread.
std::vector<Consistency> measure_consistency(int frames, std::uint64_t seed,
                                             const std::function<void(int frames)>& done);

/// Number of conditions.
std::size_t consistency_conditions();

}  // namespace lodestar
