#include "app/frames/video_camera.hpp"

namespace lodestar {

VideoCamera::VideoCamera(std::filesystem::path file, std::function<Stamp()> now)
    : video_(std::move(file)), now_(std::move(now)), next_(video_.next()) {}

std::optional<Frame> VideoCamera::poll() {
  if (!next_) return std::nullopt;
  const Stamp now = now_();
  if (!now_from_video_) now_from_video_ = now - next_->stamp;
  const Stamp due = next_->stamp + *now_from_video_;
  if (due > now) return std::nullopt;
  Frame frame{.stamp = due, .gray = std::move(next_->gray)};
  next_ = video_.next();
  return frame;
}

}  // namespace lodestar
