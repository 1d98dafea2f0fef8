#pragma once

#include <filesystem>
#include <future>

#include "app/report/run_record.hpp"
#include "app/site/site.hpp"
#include "app/viewers/run_mcap.hpp"

namespace lodestar {

/// Writes run folders in the background: the first under the given name, those of later drives beside it as
/// NAME-2, NAME-3, the first free name.
class KeptRuns {
 public:
  /// `replaces_first`: an existing first folder is overwritten; else it too gets a free name.
  KeptRuns(std::filesystem::path first, bool replaces_first, const Site& site, const std::string& camera,
           const RunMcapOptions& mcap = {});
  ~KeptRuns();
  KeptRuns(const KeptRuns&) = delete;
  KeptRuns& operator=(const KeptRuns&) = delete;

  /// Call at each step of a drive, for its run.mcap.
  void watch(const DriveMoment& moment);

  /// Call at its end. Waits while the previous run is still being written, then returns at once. A failure to
  /// write is reported on standard error and does not stop the program.
  void keep(RunRecord record);

  /// Number of runs kept.
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
