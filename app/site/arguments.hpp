#pragma once

#include <string>
#include <vector>

#include "app/site/goal.hpp"
#include "maps/places.hpp"

namespace lodestar {

/// "X,Y" in metres. Throws InputError naming the option for anything else.
Vec2 parse_point(const std::string& option, const std::string& text);

/// "X,Y[,DEG]": metres, and the final heading in degrees.
Goal parse_goal(const std::string& option, const std::string& text);

/// The same, or the name of a place. The error names the places that are spelt most like an unknown name.
Goal parse_goal(const std::string& option, const std::string& text, const Places& places);

/// The stops of a mission, once.
std::vector<Goal> goals_of(const NamedMission& mission, const Places& places);

/// Of --goal, in turn, or the places of the mission of places.yaml that --mission names, in driving order.
/// Throws InputError naming the missions that there are for an unknown name.
std::vector<Goal> goals_in(const std::vector<std::string>& goals, const std::string& mission,
                           const Places& places);

}  // namespace lodestar
