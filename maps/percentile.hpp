#pragma once

#include <optional>
#include <vector>

namespace lodestar {

/// Nearest-rank percentile: the smallest value such that at least this fraction (0..1) of the values does not
/// exceed it. Empty when there are no values.
std::optional<double> percentile(std::vector<double> values, double fraction);

}  // namespace lodestar
