#pragma once

#include <optional>
#include <vector>

namespace lodestar {

/// The smallest of the values that at least this fraction (0..1) of them does not exceed: the nearest rank.
/// Nothing of no values.
std::optional<double> percentile(std::vector<double> values, double fraction);

}  // namespace lodestar
