#include "drivers/simulation/faulty_camera.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "maps/random.hpp"

namespace lodestar {
namespace {

/// A sensor without light still has noise.
cv::Mat dark(const cv::Mat& like, Random random) {
  cv::Mat gray(like.size(), CV_8UC1);
  for (int v = 0; v < gray.rows; ++v) {
    auto* row = gray.ptr<std::uint8_t>(v);
    for (int u = 0; u < gray.cols; ++u) row[u] = static_cast<std::uint8_t>(random.below(4));
  }
  return gray;
}

cv::Mat blurred(const cv::Mat& gray, double sigma_px) {
  cv::Mat result;
  cv::GaussianBlur(gray, result, {}, sigma_px);
  return result;
}

}  // namespace

std::optional<Frame> FaultyCamera::poll() {
  while (std::optional<Frame> frame = camera_.poll())
    if (std::optional<Waiting> waiting = spoiled(std::move(*frame))) waiting_.push_back(std::move(*waiting));
  if (waiting_.empty() || waiting_.front().arrival > now_) return std::nullopt;
  Frame frame = std::move(waiting_.front().frame);
  waiting_.pop_front();
  last_ = frame.gray;
  return frame;
}

std::optional<FaultyCamera::Waiting> FaultyCamera::spoiled(Frame frame) const {
  Stamp arrival = now_;
  const Random random =
      Random(seed_).stream(static_cast<std::uint64_t>(frame.stamp.time_since_epoch().count()));
  for (const Fault& fault : active_) {
    switch (fault.kind) {
      case FaultKind::camera_dropped:
        return std::nullopt;
      case FaultKind::camera_frozen:
        if (!last_.empty()) frame.gray = last_;
        break;
      case FaultKind::camera_black:
        frame.gray = dark(frame.gray, random);
        break;
      case FaultKind::camera_saturated:
        frame.gray = cv::Mat(frame.gray.size(), CV_8UC1, cv::Scalar(255));
        break;
      case FaultKind::camera_blurred:
        frame.gray = blurred(frame.gray, fault.blur_sigma_px);
        break;
      case FaultKind::camera_late:
        arrival += from_seconds(fault.delay_s);
        break;
      case FaultKind::clock_jump:
        frame.stamp += from_seconds(fault.delay_s);
        break;
      default:
        break;
    }
  }
  return Waiting{arrival, std::move(frame)};
}

}  // namespace lodestar
