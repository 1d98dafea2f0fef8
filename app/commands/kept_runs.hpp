#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands/recorded_run.hpp"
#include "app/common/background_writer.hpp"
#include "app/report/run_record.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// Writes run folders in the background: the first under the given name, those of later drives beside it as
/// NAME-2, NAME-3, the first free name. A failure to write is logged as a warning; the drive goes on.
class KeptRuns {
 public:
  /// `replaces_first`: an existing first folder is overwritten; else it too gets a free name.
  KeptRuns(std::filesystem::path first, bool replaces_first, const Site& site, std::string camera,
           RunFolderOptions options = {});

  /// For all drives, one after the other. A drive's folder is created with its first step or frame.
  [[nodiscard]] DriveWatcher watcher();

  /// Call at the end of a drive: its folder is completed in the background. While four wait for a slow disk,
  /// no further drive is recorded.
  void keep(RunRecord record);

  /// Call after the last drive: waits until all folders are complete. False when one of them, or a part of
  /// it, is missing.
  [[nodiscard]] bool finish();

  /// Number of drives that have ended.
  [[nodiscard]] int count() const { return count_; }

 private:
  struct Ended {
    std::unique_ptr<RecordedRun> run;
    RunRecord record;
  };

  void warn(const std::string& loss);
  [[nodiscard]] std::filesystem::path next_folder() const;
  void begin();

  std::filesystem::path first_;
  bool replaces_first_;
  const Site& site_;
  std::string camera_;
  RunFolderOptions options_;
  std::atomic<bool> has_loss_ = false;  // outlives run_, which tells of losses
  std::unique_ptr<RecordedRun> run_;    ///< of the present drive, if it is recorded
  DriveWatcher watcher_;                ///< of run_
  bool has_begun_ = false;
  int count_ = 0;
  BackgroundWriter<Ended> writer_;
};

}  // namespace lodestar
