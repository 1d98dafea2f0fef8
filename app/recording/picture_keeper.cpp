#include "app/recording/picture_keeper.hpp"

#include <utility>

namespace lodestar {

PictureKeeper::PictureKeeper(PictureKeeperOptions options) : options_(std::move(options)) {}

PictureKeeper::~PictureKeeper() {
  if (!worker_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  worker_.join();
}

std::optional<KeptPicture> PictureKeeper::keep(DriveRecord& record, std::span<const Frame> frames) {
  std::optional<KeptPicture> last;
  if (options_.pictures_hz <= 0.0) return last;
  const Duration period = from_seconds(0.99 / options_.pictures_hz);
  for (const Frame& frame : frames) {
    const bool is_due = record.pictures.empty() || frame.stamp - record.pictures.back().stamp >= period;
    if (!is_due || frame.gray.empty()) continue;
    std::optional<KeptPicture> kept = hand_over(frame);
    if (!kept) continue;
    record.pictures.push_back(*kept);
    last = std::move(kept);
  }
  return last;
}

std::optional<KeptPicture> PictureKeeper::hand_over(const Frame& frame) {
  if (!worker_.joinable()) worker_ = std::thread([this] { work(); });
  Waiting waiting{.gray = frame.gray, .jpeg = {}};
  KeptPicture kept{.stamp = frame.stamp, .jpeg = waiting.jpeg.get_future().share()};
  {
    std::unique_lock lock(mutex_);
    const auto has_room = [this] { return waiting_.size() < options_.most_waiting; };
    if (options_.can_wait) changed_.wait(lock, has_room);
    if (!has_room()) return std::nullopt;
    waiting_.push_back(std::move(waiting));
  }
  changed_.notify_all();
  return kept;
}

void PictureKeeper::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    Waiting next = std::move(waiting_.front());
    lock.unlock();
    next.jpeg.set_value(options_.jpeg_of(next.gray));
    lock.lock();
    waiting_.pop_front();  // only now: a picture being encoded counts as waiting
    changed_.notify_all();
  }
}

}  // namespace lodestar
