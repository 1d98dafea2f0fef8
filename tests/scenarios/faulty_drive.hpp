#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "app/report/run_statistics.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "localization/detection/marker_detector.hpp"

// Drives through the lab while something fails, and what the robot's sensors really had of the fault.
namespace lodestar {

inline constexpr Stamp fault_begin{std::chrono::seconds(8)};  ///< of faults that name none later

/// A frame as it came to the navigator, read by a detector of the test's own.
struct FrameSeen {
  Stamp captured;  ///< as its stamp has it
  Stamp arrived;
  std::vector<DetectedMarker> markers;
  std::size_t dots = 0;
  double mean_gray = 0.0;
  bool repeats = false;  ///< the picture before, to the last pixel

  [[nodiscard]] std::ptrdiff_t count(int id) const {
    return std::ranges::count(markers, id, &DetectedMarker::id);
  }
  /// The marker that is read within a few pixels of a place; 0 for none.
  [[nodiscard]] int id_at(const Vec2& center_px) const {
    const auto near = [&](const DetectedMarker& marker) {
      return (marker.center_px - center_px).norm() < 5.0;
    };
    const auto marker = std::ranges::find_if(markers, near);
    return marker == markers.end() ? 0 : marker->id;
  }
};

struct FaultyDrive {
  RunRecord record;
  std::vector<FrameSeen> frames;
  std::vector<WheelTravel> travel;          ///< as the navigator heard it
  std::vector<StampedCanFrame> can_frames;  ///< on the bus, as the base received or sent them

  [[nodiscard]] const GoalRecord& goal() const { return record.goals.front(); }
  /// The marker that the fault befell.
  [[nodiscard]] int marker() const { return record.faults.at(0).marker.value(); }

  /// How many frames are such, of those captured within these seconds of the fault's begin.
  template <typename IsSuch>
  [[nodiscard]] std::ptrdiff_t frames_that(double from_s, double until_s, const IsSuch& is_such) const {
    return std::ranges::count_if(frames, [&](const FrameSeen& frame) {
      const double since_s = seconds(frame.captured - fault_begin);
      return since_s >= from_s && since_s < until_s && is_such(frame);
    });
  }
  template <typename IsSuch>
  [[nodiscard]] std::ptrdiff_t fixes_that(double from_s, double until_s, const IsSuch& is_such) const {
    return std::ranges::count_if(record.fixes, [&](const FixRecord& fix) {
      const double since_s = seconds(fix.stamp - fault_begin);
      return since_s >= from_s && since_s < until_s && is_such(fix);
    });
  }

  /// From the begin of the fault until the navigator said so; infinite when it never did.
  [[nodiscard]] double noticed_after_s(const std::string& words) const {
    for (const NoticeRecord& notice : record.notices)
      if (notice.stamp >= fault_begin && notice.words.find(words) != std::string::npos)
        return seconds(notice.stamp - fault_begin);
    return INFINITY;
  }

  [[nodiscard]] bool ever_had_to_stop() const {
    return std::ranges::any_of(record.notices, [](const NoticeRecord& notice) {
      return notice.stops && notice.stamp >= fault_begin;
    });
  }

  [[nodiscard]] bool distrusts(int id) const {
    return std::ranges::find(record.distrusted, id, &DistrustedMarker::id) != record.distrusted.end();
  }

  /// Without the leap of a robot that is carried.
  [[nodiscard]] double true_way_m(Stamp from, Stamp until = Stamp::max()) const {
    constexpr double longest_step_m = 0.05;
    double way_m = 0.0;
    for (std::size_t i = 1; i < record.truth.size(); ++i) {
      const TruePose& now = record.truth[i];
      const double step_m =
          (now.map_from_base.position_m - record.truth[i - 1].map_from_base.position_m).norm();
      if (now.stamp > from && now.stamp <= until && step_m < longest_step_m) way_m += step_m;
    }
    return way_m;
  }
};

inline bool reads_markers(const FrameSeen& frame) {
  return !frame.markers.empty();
}

inline bool is_accepted(const FixRecord& fix) {
  return fix.accepted;
}

inline FaultyDrive drive(std::vector<Fault> faults, std::uint64_t seed = 3, bool there_and_back = false) {
  static const Site lab = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  for (Fault& fault : faults) fault.begin = std::max(fault.begin, Duration(fault_begin.time_since_epoch()));
  FaultyDrive drive;
  MarkerDetector detector(expecting(lab.registry));
  DotFinder dots;
  cv::Mat last;
  SimulatedDriveOptions options{
      .camera = lab.default_camera, .seed = seed, .goals = lab.goals, .faults = faults};
  if (!there_and_back) options.goals.resize(1);
  options.watch.can_frame = [&](const StampedCanFrame& frame) { drive.can_frames.push_back(frame); };
  options.watch.step = [&](const DriveMoment& moment) {
    for (const Frame& frame : moment.input.frames) {
      const auto markers = detector.detect(frame.gray);
      drive.frames.push_back({.captured = frame.stamp,
                              .arrived = moment.input.now,
                              .markers = {markers.begin(), markers.end()},
                              .dots = dots.find(frame.gray).size(),
                              .mean_gray = cv::mean(frame.gray)[0],
                              .repeats = !last.empty() && cv::norm(frame.gray, last, cv::NORM_INF) == 0.0});
      last = frame.gray;
    }
    drive.travel.insert(drive.travel.end(), moment.input.base.travel.begin(), moment.input.base.travel.end());
  };
  drive.record = simulate_drive(lab, options);
  return drive;
}

/// The same drive with nothing wrong.
inline const FaultyDrive& usual_drive() {
  static const FaultyDrive usual = drive({});
  return usual;
}

}  // namespace lodestar
