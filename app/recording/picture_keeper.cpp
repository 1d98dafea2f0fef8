#include "app/recording/picture_keeper.hpp"

#include <utility>

namespace lodestar {

PictureKeeper::PictureKeeper(PictureKeeperOptions options)
    : options_(std::move(options)),
      encoder_({.most_waiting = options_.most_waiting, .can_wait = options_.can_wait}, [this](Waiting& next) {
        std::string jpeg;
        try {
          jpeg = options_.jpeg_of(next.gray);
        } catch (...) {
          next.jpeg.set_value({});  // those who wait for it must not wait for ever
          throw;
        }
        next.jpeg.set_value(std::move(jpeg));
      }) {}

std::optional<KeptPicture> PictureKeeper::keep(DriveRecord& record, std::span<const Frame> frames) {
  std::optional<KeptPicture> last;
  if (options_.pictures_hz <= 0.0) return last;
  const Duration period = from_seconds(0.99 / options_.pictures_hz);
  for (const Frame& frame : frames) {
    const bool is_due = record.pictures.empty() || frame.stamp - record.pictures.back().stamp >= period;
    if (!is_due || frame.gray.empty()) continue;
    std::optional<KeptPicture> kept = hand_over(frame);
    if (!kept) {
      ++record.dropped_pictures;
      continue;
    }
    record.pictures.push_back(*kept);
    last = std::move(kept);
  }
  return last;
}

std::optional<KeptPicture> PictureKeeper::hand_over(const Frame& frame) {
  Waiting waiting{.gray = frame.gray, .jpeg = {}};
  KeptPicture kept{.stamp = frame.stamp, .jpeg = waiting.jpeg.get_future().share()};
  if (!encoder_.put(std::move(waiting))) return std::nullopt;
  return kept;
}

}  // namespace lodestar
