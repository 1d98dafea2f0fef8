#include "planning/sampling_search.hpp"

#include <atomic>
#include <mutex>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
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

/// The plane; frees at its end the states that a planner forgot (LazyPRM* forgets all of them).
class PlaneSpace : public ob::RealVectorStateSpace {
 public:
  PlaneSpace() : ob::RealVectorStateSpace(2) {}
  ~PlaneSpace() override {
    for (ob::State* state : states_) ob::RealVectorStateSpace::freeState(state);
  }
  PlaneSpace(const PlaneSpace&) = delete;
  PlaneSpace& operator=(const PlaneSpace&) = delete;

  ob::State* allocState() const override {
    return *states_.insert(ob::RealVectorStateSpace::allocState()).first;
  }
  void freeState(ob::State* state) const override {
    states_.erase(state);
    ob::RealVectorStateSpace::freeState(state);
  }

 private:
  mutable std::unordered_set<ob::State*> states_;
};

Vec2 point_of(const ob::State* state) {
  const auto* plane = state->as<PlaneSpace::StateType>();
  return {plane->values[0], plane->values[1]};
}

/// Legs are clear exactly or not at all; no resolution is involved.
class ClearMotion : public ob::MotionValidator {
 public:
  ClearMotion(const ob::SpaceInformationPtr& information, const ClearSpace& space)
      : ob::MotionValidator(information), space_(space) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return space_.along(point_of(from), point_of(to));
  }
  /// Where a leg stops being clear is not asked for by planners that only keep whole legs.
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    if (last_valid.first != nullptr) si_->copyState(last_valid.first, from);
    last_valid.second = 0.0;
    return false;
  }

 private:
  const ClearSpace& space_;
};

ob::SpaceInformationPtr plane_of(const ClearSpace& space) {
  const auto plane = std::make_shared<PlaneSpace>();
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0.0);
  bounds.setHigh(0, space.columns());
  bounds.setHigh(1, space.rows());
  plane->setBounds(bounds);
  const auto information = std::make_shared<ob::SpaceInformation>(plane);
  information->setStateValidityChecker(
      [&space](const ob::State* state) { return space.along(point_of(state), point_of(state)); });
  information->setMotionValidator(std::make_shared<ClearMotion>(information, space));
  information->setup();
  return information;
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
  const auto objective = std::make_shared<ob::PathLengthOptimizationObjective>(information);
  objective->setCostThreshold(ob::Cost(enough_cells));
  problem->setOptimizationObjective(objective);
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

std::vector<Vec2> points_of(og::PathGeometric& path) {
  std::vector<Vec2> points;
  for (const ob::State* state : path.getStates()) points.push_back(point_of(state));
  return points;
}

}  // namespace

std::optional<SampledPath> search_by_sampling(SamplingMethod method, const ClearSpace& space,
                                              const Vec2& start, const Vec2& goal,
                                              const SamplingOptions& options) {
  static std::mutex one_seed_for_all;
  const std::lock_guard lock(one_seed_for_all);
  ompl::msg::noOutputHandler();  // it has words for every query, and a warning for a second seed
  ompl::RNG::setSeed(options.seed);

  const ob::SpaceInformationPtr information = plane_of(space);
  const ob::ProblemDefinitionPtr problem =
      problem_of(information, start, goal, options.enough_length_m / space.map().resolution_m);
  const ob::PlannerPtr planner = planner_of(method, information);
  planner->setProblemDefinition(problem);
  planner->setup();

  std::atomic<std::size_t> iterations = 0;
  const ob::PlannerTerminationCondition out_of_iterations([&] {
    return ++iterations > static_cast<std::size_t>(options.max_iterations) && options.max_iterations > 0;
  });
  const ob::PlannerStatus status = planner->solve(ob::plannerOrTerminationCondition(
      out_of_iterations, ob::timedPlannerTerminationCondition(options.time_limit_s)));
  if (status != ob::PlannerStatus::EXACT_SOLUTION)
    return std::nullopt;  // an approximate one is "true" as well
  return SampledPath{points_of(*problem->getSolutionPath()->as<og::PathGeometric>()), iterations};
}

}  // namespace lodestar
