#pragma once

#include <filesystem>

#include "app/navigation/navigation.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// The world model of a site's robot, with one of the site's cameras.
KnownWorld known_world(const Site& site, const std::string& camera);

/// The map of a site with its keep-outs as obstacles: what to plan on.
OccupancyMap drivable_map(const Site& site);

/// Whom a state learned on this site, with one of its cameras, belongs to.
StateOwner state_owner(const Site& site, const std::string& camera);

/// Where a robot keeps what it learns on the site.
std::filesystem::path state_file(const Site& site);

/// Prior of the camera's tilt and height, from the flat floor and the calibrated mount.
PosePrior pose_prior(const Robot& robot);

/// Nothing for a robot without a scanner.
std::optional<SurroundingsOptions> surroundings_options(const Robot& robot, const DriveOptions& drive);

/// Options of all navigation steps that follow from the robot's geometry and limits.
NavigationOptions navigation_options(const Robot& robot);

}  // namespace lodestar
