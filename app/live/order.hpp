#pragma once

#include <string>
#include <variant>
#include <vector>

#include "app/site/goal.hpp"

// What people at the console want of the robot. Who may want it has been settled before.
namespace lodestar {

struct GoOrder {
  std::vector<Goal> goals;
};
struct PauseOrder {};
struct ResumeOrder {};
/// Leave the latched fault of the base, if its cause is gone.
struct ClearFaultOrder {};
/// The robot stands about here.
struct PlaceOrder {
  Pose2 map_from_base;
};

struct Order {
  std::string by;  ///< who, in words
  std::variant<GoOrder, PauseOrder, ResumeOrder, ClearFaultOrder, PlaceOrder> what;
};

}  // namespace lodestar
