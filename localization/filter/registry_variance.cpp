#include "localization/filter/registry_variance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "maps/geometry.hpp"

namespace lodestar {
namespace {

// Chosen by hand: one marker in fifty was moved since the survey, by up to a hand's breadth and ten degrees.
constexpr double moved_share = 0.02;
constexpr double moved_by_m = 0.1;
constexpr double moved_by_rad = radians(10.0);
constexpr double moved_density =
    moved_share / (std::numbers::pi * moved_by_m * moved_by_m * 2.0 * moved_by_rad);

/// Of a candidate against the one beside it that is nearer to what is expected: who states a sigma mostly
/// means it, and markers once found off their places stay there.
constexpr double prior_of_doubling = 0.25;

}  // namespace

RegistryVariance::RegistryVariance(double expected) {
  for (std::size_t i = 0; i < log_posterior_.size(); ++i) {
    const double doublings = std::abs(std::log2(candidates.at(i) / expected));
    log_posterior_[i] = doublings * std::log(prior_of_doubling);
  }
}

void RegistryVariance::add(const LogDensities& of_innovation) {
  const auto evidence = [&](std::size_t i) {
    return std::log((1.0 - moved_share) * std::exp(of_innovation.at(i)) + moved_density);
  };
  for (std::size_t i = 0; i < log_posterior_.size(); ++i) {
    log_posterior_[i] += evidence(i);
    strongest_doubt_[i] = std::max(strongest_doubt_[i], evidence(i) - evidence(0));
  }
}

double RegistryVariance::likeliest() const {
  std::size_t best = 0;
  const auto without_strongest = [&](std::size_t i) { return log_posterior_.at(i) - strongest_doubt_.at(i); };
  for (std::size_t i = 1; i < candidates.size(); ++i)
    if (without_strongest(i) > without_strongest(best)) best = i;
  return candidates.at(best);
}

}  // namespace lodestar
