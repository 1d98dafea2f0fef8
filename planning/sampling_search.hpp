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

/// They go on improving their path until one of the limits. A run that the clock ends is not repeatable; one
/// that the iterations or the length end is the same for the same seed.
struct SamplingOptions {
  std::uint32_t seed = 1;        ///< at least 1
  int max_iterations = 3000;     ///< 0: no limit
  double time_limit_s = 10.0;    ///< a safeguard, unless the iterations are not limited
  double enough_length_m = 0.0;  ///< a path no longer than this is taken at once
};

struct SampledPath {
  std::vector<Vec2> points;  ///< from start to goal in grid coordinates
  std::size_t iterations = 0;
};

/// A path between two clear points with the footprint check of CollisionChecker, exact along every leg.
/// Nothing when none was found within the limits: paths that only come near to the goal do not count. OMPL
/// keeps one seed for the whole program, so calls wait for each other.
std::optional<SampledPath> search_by_sampling(SamplingMethod method, const CollisionChecker& space,
                                              const Vec2& start, const Vec2& goal,
                                              const SamplingOptions& options);

/// The same for a robot with an outline, in SE(2): from state to state it turns to the leg, drives, and turns
/// to the heading of the state, each checked exactly. Where no heading is given, the start looks towards the
/// goal or as nearly so as fits, and the goal has eight to choose from. The points are of a path that fits
/// when the robot turns from leg to leg without the headings between.
std::optional<SampledPath> search_by_sampling(SamplingMethod method, const FootprintCollisionChecker& space,
                                              const Vec2& start, const Vec2& goal,
                                              const EndHeadings& headings, const SamplingOptions& options);

}  // namespace lodestar
