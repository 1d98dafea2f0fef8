#pragma once

#include <functional>
#include <future>
#include <optional>
#include <span>
#include <string>

#include "app/common/background_writer.hpp"
#include "app/recording/drive_record.hpp"
#include "maps/frame.hpp"
#include "maps/picture.hpp"

namespace lodestar {

struct PictureKeeperOptions {
  double pictures_hz = 0.0;      ///< camera frames to keep per second; 0: none
  std::size_t most_waiting = 8;  ///< frames that have not become a JPEG yet
  /// When that many wait: true blocks until there is room, false (real time) drops the picture.
  bool can_wait = false;
  std::function<std::string(const cv::Mat&)> jpeg_of = jpeg_bytes;  ///< of a gray frame
};

/// Keeps some of a drive's camera frames. They are handed over without a copy and encoded as JPEG on a thread
/// of its own, off the control loop.
class PictureKeeper {
 public:
  /// All that was kept becomes a JPEG before it is destroyed.
  explicit PictureKeeper(PictureKeeperOptions options);

  /// Adds those that are due to the record, and counts there what found no room. Gives the last of them, if
  /// any.
  std::optional<KeptPicture> keep(DriveRecord& record, std::span<const Frame> frames);

 private:
  struct Waiting {
    cv::Mat gray;
    std::promise<std::string> jpeg;
  };

  std::optional<KeptPicture> hand_over(const Frame& frame);

  PictureKeeperOptions options_;
  BackgroundWriter<Waiting> encoder_;
};

}  // namespace lodestar
