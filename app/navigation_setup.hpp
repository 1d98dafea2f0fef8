#pragma once

#include "app/navigation.hpp"
#include "app/site.hpp"
#include "app/visibility.hpp"

namespace lodestar {

/// The world of a site as its robot knows it, seen with one of the site's cameras.
KnownWorld known_world(const Site& site, const std::string& camera);

/// Flat floor and calibrated mount: the camera's tilt and height are nearly known before looking.
PosePrior pose_prior(const Robot& robot);

/// What such a robot sees on the floor of a map.
VisibilityOptions visibility_options(const Robot& robot);

/// The options of every step of the road that follow from the robot's build.
NavigationOptions navigation_options(const Robot& robot);

}  // namespace lodestar
