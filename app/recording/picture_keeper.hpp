#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "app/common/picture_file.hpp"
#include "app/recording/drive_record.hpp"
#include "maps/frame.hpp"

namespace lodestar {

struct PictureKeeperOptions {
  double pictures_hz = 0.0;      ///< so many of the camera's frames a second; 0: none
  std::size_t most_waiting = 8;  ///< frames that have not become a JPEG yet
  /// Beyond that a drive in real time goes on without the picture; a drive that can wait does.
  bool can_wait = false;
  std::function<std::string(const cv::Mat&)> jpeg_of = jpeg_bytes;  ///< of a gray frame
};

/// Keeps some of a drive's camera frames. They are handed over as they are, without a copy, and become JPEGs
/// on a thread of their own: the control loop has none of that work.
class PictureKeeper {
 public:
  explicit PictureKeeper(PictureKeeperOptions options);
  PictureKeeper(const PictureKeeper&) = delete;
  PictureKeeper& operator=(const PictureKeeper&) = delete;
  /// All that was kept becomes a JPEG.
  ~PictureKeeper();

  /// Adds those that are due to the record. Gives the last of them, if any.
  std::optional<KeptPicture> keep(DriveRecord& record, std::span<const Frame> frames);

 private:
  struct Waiting {
    cv::Mat gray;
    std::promise<std::string> jpeg;
  };

  std::optional<KeptPicture> hand_over(const Frame& frame);
  void work();

  PictureKeeperOptions options_;
  std::mutex mutex_;  ///< of the next two
  std::deque<Waiting> waiting_;
  bool ends_ = false;
  std::condition_variable changed_;
  std::thread worker_;  ///< once there is something to do
};

}  // namespace lodestar
