#include "app/viewers/run_mcap.hpp"

#include <utility>

#include "app/report/run_folder.hpp"

namespace lodestar {

RunMcap::RunMcap(const std::filesystem::path& folder, const KnownWorld& world, RobotBody body,
                 const RunMcapOptions& options)
    : options_(options), messages_(world, std::move(body)) {
  make_run_folder(folder);
  file_ = std::make_unique<McapFile>(folder / "run.mcap", drive_channels());
  writer_ = std::thread([this] { work(); });
}

RunMcap::~RunMcap() {
  (void)finish();
}

void RunMcap::watch(const DriveMoment& moment) {
  take({.messages = messages_.of(moment), .picture = moment.picture});
}

void RunMcap::add_truth(const RunRecord& record) {
  take({.messages = truth_messages(record), .picture = std::nullopt});
}

void RunMcap::take(Portion portion) {
  if (options_.is_full && options_.is_full()) {
    has_skipped_ = true;
    return;
  }
  constexpr std::size_t bytes_of_picture = 64U << 10U;  // estimate: it may not have been encoded yet
  std::size_t bytes = portion.picture ? bytes_of_picture : 0;
  for (const Message& message : portion.messages) bytes += message.json.size();
  {
    std::unique_lock lock(mutex_);
    const auto has_room = [&] { return waiting_bytes_ < options_.most_waiting_bytes; };
    if (options_.can_wait) changed_.wait(lock, has_room);
    if (!has_room()) {
      has_skipped_ = true;
      return;
    }
    waiting_bytes_ += bytes;
    waiting_.push_back(std::move(portion));
  }
  changed_.notify_all();
}

void RunMcap::work() {
  for (bool is_last = false; !is_last;) {
    std::vector<Portion> portions;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
      is_last = ends_;
      portions = std::exchange(waiting_, {});
      waiting_bytes_ = 0;
    }
    changed_.notify_all();
    if (options_.delay) std::this_thread::sleep_for(options_.delay());
    for (const Portion& portion : portions) write(portion);
  }
}

void RunMcap::write(const Portion& portion) {
  for (const Message& message : portion.messages) file_->write(message);
  if (portion.picture) file_->write(camera_message(portion.picture->stamp, portion.picture->jpeg.get()));
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
