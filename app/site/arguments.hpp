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

/// The places of a mission of places.yaml, in driving order. Throws InputError naming the missions that there
/// are for an unknown name.
std::vector<Goal> mission_goals(const std::string& option, const std::string& name, const Places& places);

}  // namespace lodestar
