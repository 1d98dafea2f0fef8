#include "app/commands/kept_runs.hpp"

#include <fmt/core.h>

#include "app/report/run_folder.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

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

void KeptRuns::keep(RunRecord record) {
  if (writing_.valid()) writing_.wait();
  const std::filesystem::path folder = next_folder();
  ++count_;
  writing_ = std::async(std::launch::async, [this, folder, kept = std::move(record)] {
    try {
      write_run_folder(folder, kept, site_.map.map, site_.registry);
      fmt::print(stderr, "run folder: {}\n", folder.string());
    } catch (const InputError& error) {
      fmt::print(stderr, "lodestar: warning: {}\n", error.what());
    }
  });
}

}  // namespace lodestar
