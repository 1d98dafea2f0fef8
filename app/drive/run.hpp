#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/recording/drive_moment.hpp"
#include "app/report/run_record.hpp"
#include "app/site/site.hpp"
#include "drivers/base/base_protocol.hpp"
#include "drivers/camera/camera.hpp"
#include "drivers/can/can_bus.hpp"

namespace lodestar {

class OperatorSession;

/// What somebody wants of a robot that drives.
enum class OperatorWish { none, resume, stop };

struct RunOptions {
  std::string camera;  ///< a profile of the site
  std::vector<Goal> goals;
  double pictures_hz = 0.0;                      ///< camera frames to keep in the record
  bool hold_on_base_fault = true;                ///< wait for resume; else the goal fails
  std::function<OperatorWish()> operator_wish;   ///< asked at every step
  std::function<void(const std::string&)> tell;  ///< what happens, in words for people
  DriveWatcher watch;                            ///< called at every step of a drive, if there
  /// People at the console, if any: after the goals the robot waits for more from there, until it is told to
  /// stop on `operator_wish`.
  OperatorSession* session = nullptr;
  std::function<void(RunRecord)> keep;  ///< with an attendant: gets the record of each drive as it ends
};

/// Drives the real robot through the goals, in real time: the road of replay(), with a bus and a camera that
/// somebody else has opened. What the base and bus say is recorded; the truth is not known here. With an
/// attendant the record of a drive that was cut short is returned, and an empty one otherwise.
RunRecord run(const Site& site, CanBus& bus, std::unique_ptr<BaseProtocol> protocol, Camera& camera,
              const RunOptions& options);

}  // namespace lodestar
