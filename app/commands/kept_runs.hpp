#pragma once

#include <filesystem>
#include <future>

#include "app/report/run_record.hpp"
#include "app/site.hpp"

namespace lodestar {

/// Writes run folders while the robot goes on: the first as asked for, those of the drives after it as
/// NAME-2, NAME-3 beside it, whichever name is still free.
class KeptRuns {
 public:
  /// `replaces_first`: the first folder is written over when it is there; else it too gets a free name.
  KeptRuns(std::filesystem::path first, bool replaces_first, const Site& site)
      : first_(std::move(first)), replaces_first_(replaces_first), site_(site) {}
  ~KeptRuns();
  KeptRuns(const KeptRuns&) = delete;
  KeptRuns& operator=(const KeptRuns&) = delete;

  /// Waits for the one before, if that is still being written; then returns at once. What cannot be written
  /// is told on standard error, and the drive goes on.
  void keep(RunRecord record);

  /// How many have been kept.
  [[nodiscard]] int count() const { return count_; }

 private:
  [[nodiscard]] std::filesystem::path next_folder() const;

  std::filesystem::path first_;
  bool replaces_first_;
  const Site& site_;
  int count_ = 0;
  std::future<void> writing_;
};

}  // namespace lodestar
