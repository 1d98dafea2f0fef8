#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <string>

#include "app/common/background_writer.hpp"
#include "app/recording/can_log.hpp"
#include "app/recording/scan_log.hpp"
#include "app/recording/sighting_log.hpp"
#include "app/site/site.hpp"
#include "app/viewers/run_mcap.hpp"

namespace lodestar {

struct RunFolderOptions {
  std::string interface = "can0";     ///< as can.log names it
  std::optional<std::uint64_t> seed;  ///< of a simulated world
  bool can_wait = false;  ///< a simulated drive waits for the disk and leaves the same bytes each time
  /// Hears once, in words for people, that the folder is no longer whole; from a thread of its own.
  std::function<void(const std::string&)> tell;
  DiskState disk;
};

/// What has become of a run folder.
struct RunFolderEnd {
  bool has_report = false;  ///< the files that are written at the end
  std::string loss;         ///< what is missing and why; empty when nothing is
};

/// The run folder of one drive, real or simulated: run.yaml and the map and registry of site/ stand soon;
/// run.mcap, can.log, dots.csv, wheels.csv and scans.bin grow while the robot drives and are readable as far
/// as they go when the program dies; all else is written at the end.
class RecordedRun {
 public:
  /// Makes the folder and these files. Throws InputError when one of them cannot be made.
  RecordedRun(std::filesystem::path folder, const Site& site, const std::string& camera,
              const RunFolderOptions& options);

  /// For the drive that is to be recorded. Holds nobody up, but where the drive can wait.
  [[nodiscard]] DriveWatcher watcher();

  /// After the drive. Waits for the disk.
  RunFolderEnd finish(const RunRecord& record);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::function<void(const std::string&)> once(std::function<void(const std::string&)> tell);

  std::filesystem::path folder_;
  const Site& site_;
  DiskState disk_;
  std::atomic<bool> has_told_ = false;
  RunMcap mcap_;
  CanLog can_log_;
  SightingLog sighting_log_;
  std::optional<ScanLog> scan_log_;  ///< of a robot with a scanner
  std::future<void> origin_;         ///< written beside the drive, whose thread no disk may hold up
};

}  // namespace lodestar
