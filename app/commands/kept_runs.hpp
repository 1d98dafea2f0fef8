#pragma once

#include <filesystem>
#include <future>

#include "app/report/run_record.hpp"
#include "app/site.hpp"

namespace lodestar {

/// Writes run folders while the robot goes on: the first as asked for, those of the drives after it as
/// NAME-2, NAME-3 beside it.
class KeptRuns {
 public:
  KeptRuns(std::filesystem::path first, const Site& site) : first_(std::move(first)), site_(site) {}
  ~KeptRuns();
  KeptRuns(const KeptRuns&) = delete;
  KeptRuns& operator=(const KeptRuns&) = delete;

  /// Waits for the one before, if that is still being written; then returns at once. What cannot be written
  /// is told on standard error, and the drive goes on.
  void keep(RunRecord record);

  /// How many have been kept.
  [[nodiscard]] int count() const { return count_; }

 private:
  std::filesystem::path first_;
  const Site& site_;
  int count_ = 0;
  std::future<void> writing_;
};

}  // namespace lodestar
