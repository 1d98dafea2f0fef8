#pragma once

#include <filesystem>
#include <future>

#include "app/report/run_record.hpp"
#include "app/site/site.hpp"
#include "app/viewers/run_mcap.hpp"

namespace lodestar {

/// Writes run folders while the robot goes on: the first as asked for, those of the drives after it as
/// NAME-2, NAME-3 beside it, whichever name is still free.
class KeptRuns {
 public:
  /// `replaces_first`: the first folder is written over when it is there; else it too gets a free name.
  KeptRuns(std::filesystem::path first, bool replaces_first, const Site& site, const std::string& camera,
           const RunMcapOptions& mcap = {});
  ~KeptRuns();
  KeptRuns(const KeptRuns&) = delete;
  KeptRuns& operator=(const KeptRuns&) = delete;

  /// At each step of a drive, for its run.mcap.
  void watch(const DriveMoment& moment);

  /// At its end. Waits for the one before, if that is still being written; then returns at once. What cannot
  /// be written is told on standard error, and the drive goes on.
  void keep(RunRecord record);

  /// How many have been kept.
  [[nodiscard]] int count() const { return count_; }

 private:
  [[nodiscard]] std::filesystem::path next_folder() const;
  const std::filesystem::path& present_folder();

  std::filesystem::path first_;
  bool replaces_first_;
  const Site& site_;
  KnownWorld world_;
  RunMcapOptions mcap_options_;
  std::unique_ptr<RunMcap> mcap_;                ///< of the present drive
  std::optional<std::filesystem::path> folder_;  ///< of the present drive, once it has one
  bool mcap_refused_ = false;
  int count_ = 0;
  std::future<void> writing_;
};

}  // namespace lodestar
