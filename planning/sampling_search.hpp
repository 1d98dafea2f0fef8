#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planning/collision_checker.hpp"
#include "planning/footprint_collision_checker.hpp"

namespace lodestar {

/// The sampling planners of OMPL: Karaman and Frazzoli 2011 (RRT*, PRM*, here with edges checked when
/// needed), Gammell and others 2014, 2015 (Informed RRT*, BIT*), Strub and Gammell 2020 (ABIT*).
enum class SamplingMethod { rrtstar, informedrrtstar, bitstar, abitstar, prmstar };

/// A planner improves its path until it reaches one of these limits. A run ended by the clock is not
/// repeatable; one ended by iterations or length is, for the same seed.
struct SamplingOptions {
  std::uint32_t seed = 1;      ///< at least 1
  int max_iterations = 3000;   ///< 0: no limit
  double time_limit_s = 10.0;  ///< a safeguard; the only limit when max_iterations is 0
  /// A path no longer than this ends the search; in SE(2) half a cell for each radian turned is added.
  double enough_length_m = 0.0;
};

struct SampledPath {
  std::vector<Vec2> points;    ///< from start to goal in grid coordinates
  std::size_t iterations = 0;  ///< tests of the limits
};

/// A path of a disc-shaped robot between two clear points, every leg checked exactly by CollisionChecker.
/// Nothing when none reached the goal within the limits. OMPL has one seed per process, so concurrent calls
/// wait for each other.
std::optional<SampledPath> search_by_sampling(SamplingMethod method, const CollisionChecker& space,
                                              const Vec2& start, const Vec2& goal,
                                              const SamplingOptions& options);

/// The same for a robot with a footprint, in SE(2): between states it turns to the leg, drives, and turns to
/// the state's heading, each checked exactly. A start or goal without a given heading may have any of eight
/// that is clear. The returned path is clear also when the robot turns from leg to leg directly, without the
/// states' headings.
std::optional<SampledPath> search_by_sampling(SamplingMethod method, const FootprintCollisionChecker& space,
                                              const Vec2& start, const Vec2& goal,
                                              const EndHeadings& headings, const SamplingOptions& options);

}  // namespace lodestar
