#pragma once

#include "app/common/stopwatch.hpp"
#include "app/recording/drive_moment.hpp"
#include "app/recording/drive_record.hpp"
#include "app/recording/picture_keeper.hpp"
#include "app/site/site.hpp"

namespace lodestar {

struct RunRecorderOptions {
  std::string camera;          ///< a profile of the site
  std::uint64_t seed = 0;      ///< of a simulated world
  double pictures_hz = 0.0;    ///< camera frames to keep in the record
  bool pictures_wait = false;  ///< a drive that can wait for its pictures loses none
  DriveWatcher watch;
};

/// The record of one drive after the other, in simulation as in the real world: it is given what comes in and
/// what is done about it, and passes it on to who follows the drive. Between drives it takes nothing.
class RunRecorder {
 public:
  RunRecorder(const Site& site, RunRecorderOptions options);

  void begin(const std::vector<Goal>& goals, const Pose2& start = {});
  void take(const StampedCanFrame& frame);
  void take(const SensorInput& input, const MissionStep& step, const Mission& mission);
  /// Empty where no drive was recorded.
  DriveRecord end(const Mission& mission);

  [[nodiscard]] bool is_on() const { return is_on_; }
  /// As far as the drive has come.
  [[nodiscard]] const DriveRecord& record() const { return record_; }

 private:
  const Site& site_;
  RunRecorderOptions options_;
  bool is_on_ = false;
  Stopwatch watch_;
  DriveRecord record_;
  PictureKeeper pictures_;
};

}  // namespace lodestar
