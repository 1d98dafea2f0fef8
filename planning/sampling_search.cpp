#include "planning/sampling_search.hpp"

#include <functional>
#include <limits>
#include <mutex>
#include <numbers>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/prm/LazyPRMstar.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>
#include <unordered_set>

namespace lodestar {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// A state space whose destructor frees the states that a planner leaked (LazyPRM* leaks all of them).
template <typename Space>
class Remembering : public Space {
 public:
  using Space::Space;
  Remembering() = default;
  ~Remembering() override {
    for (ob::State* state : states_) Space::freeState(state);
  }
  Remembering(const Remembering&) = delete;
  Remembering& operator=(const Remembering&) = delete;

  ob::State* allocState() const override { return *states_.insert(Space::allocState()).first; }
  void freeState(ob::State* state) const override {
    states_.erase(state);
    Space::freeState(state);
  }

 private:
  mutable std::unordered_set<ob::State*> states_;
};

using PlaneSpace = Remembering<ob::RealVectorStateSpace>;

/// Not symmetric: the robot drives only forward, so the reverse motion sweeps another area.
class PoseSpace : public Remembering<ob::SE2StateSpace> {
 public:
  bool hasSymmetricInterpolate() const override { return false; }
};

Vec2 point_of(const ob::State* state) {
  const auto* plane = state->as<PlaneSpace::StateType>();
  return {plane->values[0], plane->values[1]};
}

Vec2 place_of(const ob::State* state) {
  const auto* pose = state->as<ob::SE2StateSpace::StateType>();
  return {pose->getX(), pose->getY()};
}

double heading_of(const ob::State* state) {
  return state->as<ob::SE2StateSpace::StateType>()->getYaw();
}

using IsClear = std::function<bool(const ob::State* from, const ob::State* to)>;

/// Checks a whole leg exactly, without a resolution.
class ClearMotion : public ob::MotionValidator {
 public:
  ClearMotion(const ob::SpaceInformationPtr& information, IsClear is_clear)
      : ob::MotionValidator(information), is_clear_(std::move(is_clear)) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override { return is_clear_(from, to); }
  /// Reports `from` as the last valid state: these planners keep only whole legs.
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, from);
    last_valid.second = 0.0;
    return false;
  }

 private:
  IsClear is_clear_;
};

ob::RealVectorBounds bounds_of(const OccupancyMap& map) {
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0.0);
  bounds.setHigh(0, map.columns);
  bounds.setHigh(1, map.rows);
  return bounds;
}

ob::SpaceInformationPtr plane_of(const CollisionChecker& space) {
  const auto plane = std::make_shared<PlaneSpace>(2);
  plane->setBounds(bounds_of(space.map()));
  const auto information = std::make_shared<ob::SpaceInformation>(plane);
  information->setStateValidityChecker(
      [&space](const ob::State* state) { return space.along(point_of(state), point_of(state)); });
  information->setMotionValidator(
      std::make_shared<ClearMotion>(information, [&space](const ob::State* from, const ob::State* to) {
        return space.along(point_of(from), point_of(to));
      }));
  information->setup();
  return information;
}

/// Turns to the leg, drives it, turns to the heading at its end.
bool is_clear_between(const FootprintCollisionChecker& space, const ob::State* from, const ob::State* to) {
  const Vec2 a = place_of(from);
  const Vec2 b = place_of(to);
  if (a == b) return space.turning(a, heading_of(from), heading_of(to));
  const double way_rad = heading_between(a, b);
  return space.driving(a, b) && space.turning(a, heading_of(from), way_rad) &&
         space.turning(b, way_rad, heading_of(to));
}

/// `both_ways`: for planners with undirected edges.
ob::SpaceInformationPtr poses_of(const FootprintCollisionChecker& space, bool both_ways) {
  const auto poses = std::make_shared<PoseSpace>();
  poses->setBounds(bounds_of(space.map()));
  const auto information = std::make_shared<ob::SpaceInformation>(poses);
  information->setStateValidityChecker(
      [&space](const ob::State* state) { return space.at(place_of(state), heading_of(state)); });
  information->setMotionValidator(std::make_shared<ClearMotion>(
      information, [&space, both_ways](const ob::State* from, const ob::State* to) {
        return is_clear_between(space, from, to) && (!both_ways || is_clear_between(space, to, from));
      }));
  information->setup();
  return information;
}

/// The given heading, or those of eight in which the footprint is clear.
std::vector<double> headings_at(const FootprintCollisionChecker& space, const Vec2& point,
                                std::optional<double> wanted_rad) {
  if (wanted_rad) return {*wanted_rad};
  std::vector<double> headings_rad;
  for (int i = 0; i < 8; ++i) {
    const double heading_rad = wrap_angle(i * std::numbers::pi / 4.0);
    if (space.at(point, heading_rad)) headings_rad.push_back(heading_rad);
  }
  return headings_rad;
}

ob::OptimizationObjectivePtr shortest(const ob::SpaceInformationPtr& information, double enough_cells) {
  const auto objective = std::make_shared<ob::PathLengthOptimizationObjective>(information);
  objective->setCostThreshold(ob::Cost(enough_cells));
  return objective;
}

ob::ProblemDefinitionPtr problem_of(const ob::SpaceInformationPtr& information, const Vec2& start,
                                    const Vec2& goal, double enough_cells) {
  ob::ScopedState<PlaneSpace> from(information->getStateSpace());
  ob::ScopedState<PlaneSpace> to(information->getStateSpace());
  for (unsigned axis = 0; axis < 2; ++axis) {
    from[axis] = start[axis];
    to[axis] = goal[axis];
  }
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(from, to);
  problem->setOptimizationObjective(shortest(information, enough_cells));
  return problem;
}

ob::ProblemDefinitionPtr problem_of(const ob::SpaceInformationPtr& information,
                                    const FootprintCollisionChecker& space, const Vec2& start,
                                    const Vec2& goal, const EndHeadings& headings, double enough_cells) {
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  const auto pose = [&](const Vec2& point, double heading_rad) {
    ob::ScopedState<ob::SE2StateSpace> state(information->getStateSpace());
    state->setXY(point.x(), point.y());
    state->setYaw(heading_rad);
    state.enforceBounds();  // OMPL's headings are in [-pi, pi)
    return state;
  };
  for (const double heading_rad : headings_at(space, start, headings.start_rad))
    problem->addStartState(pose(start, heading_rad));
  const auto goals = std::make_shared<ob::GoalStates>(information);
  for (const double heading_rad : headings_at(space, goal, headings.goal_rad))
    goals->addState(pose(goal, heading_rad));
  problem->setGoal(goals);
  problem->setOptimizationObjective(shortest(information, enough_cells));
  return problem;
}

ob::PlannerPtr planner_of(SamplingMethod method, const ob::SpaceInformationPtr& information) {
  switch (method) {
    case SamplingMethod::rrtstar:
      return std::make_shared<og::RRTstar>(information);
    case SamplingMethod::informedrrtstar:
      return std::make_shared<og::InformedRRTstar>(information);
    case SamplingMethod::bitstar:
      return std::make_shared<og::BITstar>(information);
    case SamplingMethod::abitstar:
      return std::make_shared<og::ABITstar>(information);
    case SamplingMethod::prmstar:
      return std::make_shared<og::LazyPRMstar>(information);
  }
  return nullptr;
}

struct Solution {
  std::vector<const ob::State*> states;  ///< owned by the problem
  std::size_t iterations = 0;
};

/// Nothing when no exact solution was found within the limits.
std::optional<Solution> solution_of(SamplingMethod method, const ob::SpaceInformationPtr& information,
                                    const ob::ProblemDefinitionPtr& problem, const SamplingOptions& options) {
  const ob::PlannerPtr planner = planner_of(method, information);
  planner->setProblemDefinition(problem);
  planner->setup();
  ob::IterationTerminationCondition out_of_iterations(options.max_iterations > 0
                                                          ? static_cast<unsigned>(options.max_iterations)
                                                          : std::numeric_limits<unsigned>::max());
  const ob::PlannerStatus status = planner->solve(ob::plannerOrTerminationCondition(
      out_of_iterations, ob::timedPlannerTerminationCondition(options.time_limit_s)));
  if (status != ob::PlannerStatus::EXACT_SOLUTION)
    return std::nullopt;  // PlannerStatus is true for an approximate solution as well
  Solution solution{.states = {}, .iterations = out_of_iterations.getTimesCalled()};
  for (const ob::State* state : problem->getSolutionPath()->as<og::PathGeometric>()->getStates())
    solution.states.push_back(state);
  return solution;
}

/// Sets OMPL's seed, of which there is one per process; valid while the returned lock is held.
std::unique_lock<std::mutex> seeded(std::uint32_t seed) {
  static std::mutex one_seed_for_all;
  std::unique_lock lock(one_seed_for_all);
  ompl::msg::noOutputHandler();  // OMPL logs every query, and warns of a second seed
  ompl::RNG::setSeed(seed);
  return lock;
}

}  // namespace

std::optional<SampledPath> search_by_sampling(SamplingMethod method, const CollisionChecker& space,
                                              const Vec2& start, const Vec2& goal,
                                              const SamplingOptions& options) {
  const std::unique_lock lock = seeded(options.seed);
  const ob::SpaceInformationPtr information = plane_of(space);
  const ob::ProblemDefinitionPtr problem =
      problem_of(information, start, goal, options.enough_length_m / space.map().resolution_m);
  const std::optional<Solution> solution = solution_of(method, information, problem, options);
  if (!solution) return std::nullopt;
  SampledPath path{.points = {}, .iterations = solution->iterations};
  for (const ob::State* state : solution->states) path.points.push_back(point_of(state));
  return path;
}

std::optional<SampledPath> search_by_sampling(SamplingMethod method, const FootprintCollisionChecker& space,
                                              const Vec2& start, const Vec2& goal,
                                              const EndHeadings& headings, const SamplingOptions& options) {
  const std::unique_lock lock = seeded(options.seed);
  const ob::SpaceInformationPtr information = poses_of(space, method == SamplingMethod::prmstar);
  const ob::ProblemDefinitionPtr problem = problem_of(information, space, start, goal, headings,
                                                      options.enough_length_m / space.map().resolution_m);
  const std::optional<Solution> solution = solution_of(method, information, problem, options);
  if (!solution) return std::nullopt;
  SampledPath path{.points = {}, .iterations = solution->iterations};
  for (const ob::State* state : solution->states) {
    const Vec2 place = place_of(state);
    if (path.points.empty() || path.points.back() != place) path.points.push_back(place);
  }
  if (!space.along(path.points, headings)) return std::nullopt;
  return path;
}

}  // namespace lodestar
