#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/common/background_writer.hpp"
#include "app/navigation/navigation.hpp"
#include "app/placement/placed_scans.hpp"

namespace lodestar {

struct LiveMapOptions {
  OccupancyBuilderOptions builder;
  PlacedScansOptions scans;
  std::string made_by = "lodestar";            ///< a comment in the map's file
  Duration period = std::chrono::seconds(10);  ///< of the drive, from one file to the next
  /// Steps that may wait for a slow disk: 40 s.
  std::size_t most_waiting = 2000;
  bool can_wait = false;                         ///< a simulated drive leaves the same map each time
  std::function<void(const std::string&)> tell;  ///< hears once, from a thread of its own, what went wrong
};

/// An occupancy map that is built while the robot drives, as map_from_runs() builds it afterwards, and
/// written again and again. Nothing of it goes back into the drive. A thread of its own does the work.
class LiveMap {
 public:
  /// Throws InputError when there is no such folder, or for a name that is not that of a YAML file.
  LiveMap(std::filesystem::path file, const ScannerMount& mount, const LiveMapOptions& options = {});

  /// Once a control step, with the pose after it; does not wait, but where the drive can.
  void take(const std::vector<Scan>& scans, const std::optional<PoseEstimate>& estimate);

  /// Writes the map as it is at the end. Returns what is missing and why; empty when nothing is.
  std::string finish();

  /// After finish().
  [[nodiscard]] const ScanCounts& counts() const { return placed_.counts(); }

 private:
  struct Heard {
    std::vector<Scan> scans;
    std::optional<RunPose> pose;
  };

  void add(Heard& heard);
  void place();
  void write() const;

  std::filesystem::path file_;
  LiveMapOptions options_;
  OccupancyBuilder builder_;
  PlacedScans placed_;
  std::deque<Scan> waiting_;  ///< for the poses of their time
  Stamp newest_pose_;
  std::optional<Stamp> written_;
  BackgroundWriter<Heard> writer_;  ///< last: its thread uses the others
};

}  // namespace lodestar
