#include "app/drive/site_frames.hpp"

#include <fmt/format.h>
#include <thread>

#include "app/drive/camera_setup.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

SiteFrames::SiteFrames(const Site& site) : name_(site.camera) {
  if (site.camera == "simulated")
    throw InputError(site.folder / "site.yaml", 0, "camera: simulated", "a camera: its world has no board");
  camera_ = open_camera(site, {}, 0);
}

std::optional<Frame> SiteFrames::newest() {
  std::optional<Frame> newest;
  while (std::optional<Frame> frame = camera_->poll()) newest = std::move(frame);
  return newest;
}

std::optional<SourceFrame> SiteFrames::next() {
  constexpr Duration pause = std::chrono::milliseconds(5);
  constexpr Duration patience = std::chrono::seconds(5);  // well above slow exposures and slow start-up
  for (Duration waited{}; waited < patience && !Interruption::asked(); waited += pause) {
    if (std::optional<Frame> frame = newest()) {
      const int number = frame_++;
      return SourceFrame{.name = fmt::format("{}#{}", name_, number),
                         .picture = fmt::format("{:06}", number),
                         .of_sequence = true,
                         .stamp = frame->stamp,
                         .gray = std::move(frame->gray)};
    }
    std::this_thread::sleep_for(pause);
  }
  if (frame_ == 0 && !Interruption::asked())
    throw InputError(fmt::format("{}: found no frame in 5 s, wanted a camera that sends frames", name_));
  return std::nullopt;
}

}  // namespace lodestar
