#include "app/commands/kept_runs.hpp"

#include <fmt/core.h>

#include "app/navigation/navigation_setup.hpp"
#include "app/report/run_folder.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

KeptRuns::KeptRuns(std::filesystem::path first, bool replaces_first, const Site& site,
                   const std::string& camera, const RunMcapOptions& mcap)
    : first_(std::move(first)),
      replaces_first_(replaces_first),
      site_(site),
      world_(known_world(site, camera)),
      mcap_options_(mcap) {}

KeptRuns::~KeptRuns() {
  if (writing_.valid()) writing_.wait();
}

std::filesystem::path KeptRuns::next_folder() const {
  if (count_ == 0 && replaces_first_) return first_;
  std::filesystem::path folder = first_;
  for (int number = 2; std::filesystem::exists(folder); ++number) {
    folder = fmt::format("{}-{}", first_.string(), number);
  }
  return folder;
}

const std::filesystem::path& KeptRuns::present_folder() {
  if (!folder_) folder_ = next_folder();
  return *folder_;
}

void KeptRuns::watch(const DriveMoment& moment) {
  if (mcap_refused_) return;
  try {
    if (!mcap_)
      mcap_ = std::make_unique<RunMcap>(present_folder(), world_, body_of(site_.robot), mcap_options_);
    mcap_->watch(moment);
  } catch (const InputError& error) {
    mcap_refused_ = true;
    fmt::print(stderr, "lodestar: warning: {}\n", error.what());
  }
}

void KeptRuns::keep(RunRecord record) {
  mcap_refused_ = false;
  if (writing_.valid()) writing_.wait();
  const std::filesystem::path folder = present_folder();
  folder_.reset();
  ++count_;
  writing_ =
      std::async(std::launch::async, [this, folder, kept = std::move(record), mcap = std::move(mcap_)] {
        std::string lost;
        if (mcap) mcap->add_truth(kept);
        if (mcap && !mcap->finish()) lost = RunMcap::words_of_loss;
        try {
          if (mcap_options_.is_full && mcap_options_.is_full()) throw InputError("the disk is full");
          write_run_folder(folder, kept, site_.map.map, site_.registry);
        } catch (const InputError& error) {
          lost = error.what();
        }
        if (lost.empty()) {
          fmt::print(stderr, "run folder: {}\n", folder.string());
        } else {
          fmt::print(stderr, "lodestar: warning: the run is not recorded as a whole: {}\n", lost);
        }
      });
}

}  // namespace lodestar
