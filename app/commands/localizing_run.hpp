#pragma once

#include <functional>
#include <string>

#include "app/commands/ros2_service.hpp"
#include "app/common/command.hpp"
#include "app/drive/run.hpp"
#include "app/site/site.hpp"

namespace lodestar {

struct LocalizingRun {
  Ros2Arguments ros2;
  bool reads_odometry = false;  ///< of topic odom; else of what the base says on CAN
  std::string interface;        ///< of CAN; empty: the site's
  std::uint64_t seed = 1;       ///< of a simulated camera
};

/// Publishes where a robot is that another program drives, until told to stop: commands nothing, and sends
/// nothing on the base's bus.
ExitCode run_localizing(const Site& site, const LocalizingRun& how, std::function<OperatorWish()> wish);

}  // namespace lodestar
