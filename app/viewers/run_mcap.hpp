#pragma once

#include <filesystem>
#include <memory>

#include "app/report/run_record.hpp"
#include "app/viewers/drive_messages.hpp"
#include "app/viewers/mcap_file.hpp"

namespace lodestar {

/// Writes run.mcap into a run folder while the robot drives: open it in Foxglove, Lichtblick or any other
/// reader of MCAP files.
class RunMcap {
 public:
  /// Makes the folder. Throws InputError when that or the file cannot be made.
  RunMcap(const std::filesystem::path& folder, const KnownWorld& world, double robot_radius_m);

  void watch(const DriveMoment& moment);

  /// After the drive: what only its judge knows.
  void add_truth(const RunRecord& record);

  /// Has the disk taken all of it?
  [[nodiscard]] bool healthy() const { return file_->healthy(); }

 private:
  DriveMessages messages_;
  std::unique_ptr<McapFile> file_;
};

}  // namespace lodestar
