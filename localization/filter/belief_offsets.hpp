#pragma once

#include "localization/filter/belief.hpp"

// The markers' offsets from their registered places, as a belief has them.
namespace lodestar {

/// Gives each marker of the fix a state, and forgets those that no fix has used for longest.
void remember_offsets(const PlanarFix& fix, Belief& belief);

/// As if the registry had been so good, or so bad, from the beginning: only what is known by the offsets that
/// are still remembered changes.
Belief with_registry_variance(const Belief& belief, double variance);

/// Derivative of a fix of the belief's time: it shows the robot's pose, the error that nearby fixes share,
/// and what the offsets of its markers, which the belief remembers, move it by.
Belief::ByState fix_by_state(const Belief& belief, const PlanarFix& fix);

}  // namespace lodestar
