#include "app/simulate/simulated_fleet.hpp"

#include <algorithm>
#include <deque>
#include <memory>

#include "app/simulate/simulated_robot.hpp"
#include "maps/robot_shape.hpp"

namespace lodestar {
namespace {

/// A robot as the others meet it, moved on since the step before.
DiscState disc_of(const Pose2& map_from_base, const DiscState& before) {
  DiscState disc = before;
  disc.position_m = map_from_base.position_m;
  disc.velocity_mps =
      (disc.position_m - before.position_m) / seconds(Duration(SimulatedRobot::control_period));
  return disc;
}

std::vector<DiscState> others_of(const std::vector<DiscState>& discs, std::size_t robot) {
  std::vector<DiscState> others = discs;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(robot));
  return others;
}

/// A member of the fleet: its site differs from the others' by the start.
struct Member {
  Site site;
  SimulatedDriveOptions options;
  std::unique_ptr<SimulatedRobot> robot;
};

std::vector<DiscState> discs_at_start(const Site& site, const std::vector<FleetRobot>& robots) {
  const RobotShape shape =
      site.robot.footprint ? RobotShape(*site.robot.footprint) : RobotShape(site.robot.radius_m);
  std::vector<DiscState> discs;
  for (const FleetRobot& robot : robots)
    discs.push_back({.radius_m = shape.outer_radius_m(), .position_m = robot.start.position_m});
  return discs;
}

}  // namespace

std::vector<ConductedDrive> simulate_fleet(const Site& site, const SimulatedDriveOptions& options,
                                           const std::vector<FleetRobot>& robots,
                                           const std::function<bool()>& goes_on) {
  std::vector<DiscState> discs = discs_at_start(site, robots);
  std::deque<Member> members;  // robots refer to their site and options
  for (std::size_t i = 0; i < robots.size(); ++i) {
    Member& member = members.emplace_back(Member{.site = site, .options = options, .robot = {}});
    member.site.start = robots[i].start;
    member.options.seed = options.seed + i;
    member.options.others = others_of(discs, i);
    member.options.on_input = robots[i].on_input;
    member.robot = std::make_unique<SimulatedRobot>(member.site, member.options);
  }
  Pace pace;
  while (goes_on()) {
    for (std::size_t i = 0; i < robots.size(); ++i) {
      SimulatedRobot& robot = *members[i].robot;
      robot.move_others(others_of(discs, i));
      robots[i].conduct(robot.step(), robot.mission());
    }
    for (std::size_t i = 0; i < robots.size(); ++i)
      discs[i] = disc_of(members[i].robot->scorer().track().back().map_from_base, discs[i]);
    pace.keep();
  }
  std::vector<ConductedDrive> driven;
  for (const Member& member : members) driven.push_back(member.robot->unrecorded());
  return driven;
}

}  // namespace lodestar
