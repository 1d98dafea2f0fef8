#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/site/goal.hpp"
#include "maps/motion.hpp"
#include "maps/zones.hpp"

// Orders of operators at the console. Their permission has been checked before.
namespace lodestar {

struct GoOrder {
  std::vector<Goal> goals;
  std::uint64_t ticket = 0;  ///< by which the end of the drive is told; 0: nobody asks
  bool is_more = false;      ///< behind the goals of the present drive, if there is one; not in their place
};
struct PauseOrder {};
struct ResumeOrder {};
/// Clears the latched fault of the base, if its cause is gone.
struct ClearFaultOrder {};
/// Sets the initial pose (sigma 0.25 m, 10 degrees).
struct PlaceOrder {
  Pose2 map_from_base;
};
/// Moves by hand: holds for a moment only, so that a client that falls silent lets the robot come to rest.
struct SteerOrder {
  BodyVelocity wanted;
};

/// Obeys these from now on.
struct PlacesOrder {
  Zones zones;
  std::optional<Pose2> map_from_dock;  ///< of a site where the robot charges
};
/// To the dock, as soon as the present drive has been stopped.
struct ChargeOrder {};

struct Order {
  std::string by;  ///< who, in words
  std::variant<GoOrder, PauseOrder, ResumeOrder, ClearFaultOrder, PlaceOrder, SteerOrder, PlacesOrder,
               ChargeOrder>
      what;
};

}  // namespace lodestar
