#pragma once

#include <functional>
#include <string>

#include "app/drive/run.hpp"
#include "app/site/site.hpp"
#include "drivers/camera/camera.hpp"

namespace lodestar {

struct LocalizeOnlyOptions {
  std::string camera;                                      ///< a profile of the site
  std::function<BaseFeedback(Stamp now)> feedback;         ///< the odometry since the last call
  std::function<OperatorWish()> operator_wish;             ///< asked at every step; stop ends it
  std::function<void(Severity, const std::string&)> tell;  ///< reports events, in words
  std::function<void(Stamp)> on_step;                      ///< called after each step
  Scanner* scanner = nullptr;                              ///< of a robot that has one
  DepthCamera* depth_camera = nullptr;                     ///< likewise
  std::function<void(const SensorInput&, const MissionStep&, Mission&)> attend;  ///< called after each step
};

/// The localizer by itself, for a robot that another program drives: the same steps as run() in real time,
/// but no command of theirs goes anywhere, and nothing is sent on the base's bus.
void localize_only(const Site& site, Camera& camera, const LocalizeOnlyOptions& options);

}  // namespace lodestar
