#pragma once

#include "app/navigation/navigation.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// The world of a site as its robot knows it, seen with one of the site's cameras.
KnownWorld known_world(const Site& site, const std::string& camera);

/// Flat floor and calibrated mount: the camera's tilt and height are nearly known before looking.
PosePrior pose_prior(const Robot& robot);

/// The options of every step of the road that follow from the robot's build.
NavigationOptions navigation_options(const Robot& robot);

}  // namespace lodestar
