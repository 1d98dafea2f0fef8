#include "app/viewers/run_mcap.hpp"

#include <utility>

#include "app/report/run_folder.hpp"

namespace lodestar {

RunMcap::RunMcap(const std::filesystem::path& folder, const KnownWorld& world, double robot_radius_m,
                 const RunMcapOptions& options)
    : options_(options), messages_(world, robot_radius_m) {
  make_run_folder(folder);
  file_ = std::make_unique<McapFile>(folder / "run.mcap", drive_channels());
  writer_ = std::thread([this] { work(); });
}

RunMcap::~RunMcap() {
  (void)finish();
}

void RunMcap::watch(const DriveMoment& moment) {
  take(messages_.of(moment));
}

void RunMcap::add_truth(const RunRecord& record) {
  take(truth_messages(record));
}

void RunMcap::take(std::vector<Message> messages) {
  if (options_.is_full && options_.is_full()) {
    has_skipped_ = true;
    return;
  }
  std::size_t bytes = 0;
  for (const Message& message : messages) bytes += message.json.size();
  {
    std::unique_lock lock(mutex_);
    const auto has_room = [&] { return waiting_bytes_ < options_.most_waiting_bytes; };
    if (options_.can_wait) changed_.wait(lock, has_room);
    if (!has_room()) {
      has_skipped_ = true;
      return;
    }
    waiting_bytes_ += bytes;
    for (Message& message : messages) waiting_.push_back(std::move(message));
  }
  changed_.notify_all();
}

void RunMcap::work() {
  for (bool is_last = false; !is_last;) {
    std::vector<Message> messages;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
      is_last = ends_;
      messages = std::exchange(waiting_, {});
      waiting_bytes_ = 0;
    }
    changed_.notify_all();
    if (options_.delay) std::this_thread::sleep_for(options_.delay());
    for (const Message& message : messages) file_->write(message);
  }
}

bool RunMcap::finish() {
  if (writer_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    writer_.join();
    file_->finish();
  }
  return file_->healthy() && !has_skipped_;
}

}  // namespace lodestar
