#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "app/common/log.hpp"
#include "app/recording/drive_moment.hpp"
#include "app/report/run_record.hpp"
#include "app/site/site.hpp"
#include "drivers/base/base_protocol.hpp"
#include "drivers/camera/camera.hpp"
#include "drivers/camera/depth_camera.hpp"
#include "drivers/can/can_bus.hpp"
#include "drivers/scanner/scanner.hpp"

namespace lodestar {

class OperatorSession;

/// What the operator at the terminal asks for during a drive.
enum class OperatorWish { none, resume, stop };

struct RunOptions {
  std::string camera;  ///< a profile of the site
  std::vector<Goal> goals;
  double pictures_hz = 0.0;                                ///< camera frames to keep in the record
  bool hold_on_base_fault = true;                          ///< wait for resume; else the goal fails
  std::function<OperatorWish()> operator_wish;             ///< asked at every step
  std::function<void(Severity, const std::string&)> tell;  ///< reports events, in words
  DriveWatcher watch;                                      ///< called during each drive
  std::function<void(const SensorInput&)> on_input;        ///< hears of all input, in drives and between
  std::function<void()> on_end;        ///< called after the last step, before files are completed
  std::function<void(Stamp)> on_step;  ///< called after each step of the control loop
  std::filesystem::path state;         ///< file of what the robot learns; empty: the site's
  /// Decides after each step what the mission does next; false ends the run.
  std::function<bool(const MissionStep&, Mission&)> conduct;
  /// Takes part after each step, like `conduct`, and decides nothing about the end.
  std::function<void(const SensorInput&, const MissionStep&, Mission&)> attend;
  bool until_stopped = false;  ///< goes on after the goals until told to stop
  /// The console's operator session, if any: after the goals the robot waits for more from it, until
  /// `operator_wish` says stop.
  OperatorSession* session = nullptr;
  Scanner* scanner = nullptr;           ///< of a robot that has one
  DepthCamera* depth_camera = nullptr;  ///< likewise
  std::function<void(RunRecord)> keep;  ///< with a session: receives the record of each drive as it ends
};

/// Drives the real robot through the goals, in real time: the same steps as simulate_drive(), on an opened
/// bus and camera. Base feedback and bus traffic are recorded; there is no ground truth. With a session the
/// record of an interrupted drive is returned, and an empty one otherwise.
RunRecord run(const Site& site, CanBus& bus, std::unique_ptr<BaseProtocol> protocol, Camera& camera,
              const RunOptions& options);

}  // namespace lodestar
