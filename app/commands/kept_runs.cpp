#include "app/commands/kept_runs.hpp"

#include <fmt/core.h>

#include "app/common/log.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

void KeptRuns::warn(const std::string& loss) {
  has_loss_ = true;
  log_warning("the run is not recorded as a whole: " + loss);
}

KeptRuns::KeptRuns(std::filesystem::path first, bool replaces_first, const Site& site, std::string camera,
                   RunFolderOptions options)
    : first_(std::move(first)),
      replaces_first_(replaces_first),
      site_(site),
      camera_(std::move(camera)),
      options_(std::move(options)),
      writer_({.most_waiting = 4, .tell = [this](const std::string& loss) { warn(loss); }},
              [this](const Ended& ended) {
                const RunFolderEnd end = ended.run->finish(ended.record);
                if (!end.loss.empty()) warn(end.loss);
                if (end.has_report) log_info("run folder: " + ended.run->folder().string());
              }) {
  options_.tell = [this](const std::string& loss) { warn(loss); };
}

DriveWatcher KeptRuns::watcher() {
  return {.step =
              [this](const DriveMoment& moment) {
                begin();
                if (run_) watcher_.step(moment);
              },
          .can_frame =
              [this](const StampedCanFrame& frame) {
                begin();
                if (run_) watcher_.can_frame(frame);
              }};
}

std::filesystem::path KeptRuns::next_folder() const {
  if (count_ == 0 && replaces_first_) return first_;
  std::filesystem::path folder = first_;
  for (int number = 2; std::filesystem::exists(folder); ++number) {
    folder = fmt::format("{}-{}", first_.string(), number);
  }
  return folder;
}

void KeptRuns::begin() {
  if (std::exchange(has_begun_, true)) return;
  if (!writer_.accepts()) return warn("the disk has not taken the four drives before it");
  try {
    run_ = std::make_unique<RecordedRun>(next_folder(), site_, camera_, options_);
    watcher_ = run_->watcher();
    log_debug("recording to " + run_->folder().string());
  } catch (const InputError& error) {
    warn(error.what());
  }
}

void KeptRuns::keep(RunRecord record) {
  begin();  // a drive that ended before its first step leaves a folder too
  has_begun_ = false;
  ++count_;
  watcher_ = {};
  if (run_) writer_.put({std::exchange(run_, nullptr), std::move(record)});
}

bool KeptRuns::finish() {
  (void)writer_.finish();
  return !has_loss_;
}

}  // namespace lodestar
