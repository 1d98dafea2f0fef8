#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/common/background_writer.hpp"
#include "app/navigation/navigation.hpp"
#include "app/recording/ceiling_follower.hpp"
#include "localization/detection/marker_detector.hpp"
#include "localization/survey/survey_log.hpp"

namespace lodestar {

struct SightingLogOptions {
  /// Frames and wheel readings that may wait: some seconds of both, 0.3 MB a frame.
  std::size_t most_waiting = 256;
  bool can_wait = false;
  std::function<void(const std::string&)> tell;
  DiskState disk;
  /// Hear what is written, on the log's thread.
  std::function<void(const SurveyFrame&)> on_frame;
  std::function<void(const WheelTravel&)> on_travel;
  std::function<void(const VisualOdometryIncrement&)> on_ceiling;
};

/// What a survey takes of a drive: dots.csv, the dots of every marker that each frame shows, registered or
/// not, wheels.csv, the wheel readings, and ceiling.csv, how the ceiling itself moved. All grow while the
/// robot drives. Frames are read for it on a thread of its own, so that neither they nor the disk delay wheel
/// commands.
class SightingLog {
 public:
  /// Throws InputError when a file cannot be made.
  SightingLog(const std::filesystem::path& folder, const Robot& robot, const CameraModel& camera,
              const SightingLogOptions& options);

  /// Does not wait, but where the drive can.
  void take(const SensorInput& input);

  /// Waits until everything is written. Returns what is missing and why; empty when nothing is.
  std::string finish() { return writer_.finish().loss("dots.csv, wheels.csv and ceiling.csv"); }

 private:
  struct Item {
    std::vector<Frame> frames;
    std::vector<WheelTravel> travel;
  };
  void write(const Item& item);
  void write(const Frame& frame);
  void write(const VisualOdometryIncrement& motion);
  void check() const;

  std::filesystem::path folder_;
  std::ofstream dots_;
  std::ofstream wheels_;
  std::ofstream ceiling_;
  MarkerDetector detector_;
  CeilingFollower follower_;
  std::optional<Stamp> last_travel_;
  std::function<void(const SurveyFrame&)> on_frame_;
  std::function<void(const WheelTravel&)> on_travel_;
  std::function<void(const VisualOdometryIncrement&)> on_ceiling_;
  BackgroundWriter<Item> writer_;  ///< last: its thread uses the others
};

}  // namespace lodestar
