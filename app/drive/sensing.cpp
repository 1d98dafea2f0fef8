#include "app/drive/sensing.hpp"

namespace lodestar {

SensorInput sensed(Stamp now, BaseFeedback base, Camera& camera, Scanner* scanner, DepthCamera* depth) {
  constexpr std::size_t most_frames = 2;
  SensorInput input{.now = now, .frames = {}, .base = std::move(base)};
  while (input.frames.size() < most_frames) {
    std::optional<Frame> frame = camera.poll();
    if (!frame) break;
    input.frames.push_back(std::move(*frame));
  }
  if (scanner != nullptr) {
    while (std::optional<Scan> scan = scanner->poll()) input.scans.push_back(std::move(*scan));
    input.packets = scanner->packets();
  }
  while (depth != nullptr) {
    std::optional<DepthImage> image = depth->poll();
    if (!image) break;
    input.depths.push_back(std::move(*image));
  }
  return input;
}

}  // namespace lodestar
