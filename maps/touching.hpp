#pragma once

namespace lodestar {

/// In cells: rounding must not turn touching into overlapping.
inline constexpr double touching = 1e-9;

}  // namespace lodestar
