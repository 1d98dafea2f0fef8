#pragma once

#include "app/navigation.hpp"
#include "app/site.hpp"

namespace lodestar {

/// The world of a site as its robot knows it, seen with one of the site's cameras.
KnownWorld known_world(const Site& site, const std::string& camera);

/// The options of every step of the road that follow from the robot's build.
NavigationOptions navigation_options(const Robot& robot);

}  // namespace lodestar
