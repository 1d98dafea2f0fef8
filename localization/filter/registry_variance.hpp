#pragma once

#include <array>

namespace lodestar {

/// How far a site's markers really are off their registered places: variance of their offsets in squared
/// sigmas of the registry, learned in the drive. What each marker is off by, as the first fix that uses it
/// shows against the estimate, has a likelihood under each candidate (empirical Bayes: MacKay, "Bayesian
/// interpolation", 1992). Markers that were moved since are no evidence: they are likelier outliers.
class RegistryVariance {
 public:
  /// From as good as it says to a sigma of 5.7 times that. Better than it says never pays.
  static constexpr std::array<double, 6> candidates{1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
  using LogDensities = std::array<double, candidates.size()>;

  /// `expected`, one of the candidates, is what an earlier drive found, or the registry's word.
  explicit RegistryVariance(double expected = candidates.front());

  /// The logarithms of the density (1/(m^2 rad)) that an innovation has under each candidate.
  void add(const LogDensities& of_innovation);

  [[nodiscard]] double likeliest() const;

 private:
  LogDensities log_posterior_{};  ///< but for a constant
  /// Of one marker, against the registry as it says. It does not count: no single marker decides.
  LogDensities strongest_doubt_{};
};

}  // namespace lodestar
