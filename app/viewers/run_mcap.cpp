#include "app/viewers/run_mcap.hpp"

#include "app/report/run_folder.hpp"

namespace lodestar {

RunMcap::RunMcap(const std::filesystem::path& folder, const KnownWorld& world, double robot_radius_m)
    : messages_(world, robot_radius_m) {
  make_run_folder(folder);
  file_ = std::make_unique<McapFile>(folder / "run.mcap", drive_channels());
}

void RunMcap::watch(const DriveMoment& moment) {
  for (const Message& message : messages_.of(moment)) file_->write(message);
}

void RunMcap::add_truth(const RunRecord& record) {
  for (const Message& message : truth_messages(record)) file_->write(message);
}

}  // namespace lodestar
