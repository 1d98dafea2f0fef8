#pragma once

#include <memory>

#include "app/common/interruption.hpp"
#include "app/frames/frame_source.hpp"
#include "app/site/site.hpp"
#include "drivers/camera/camera.hpp"

namespace lodestar {

/// The newest frame of a site's camera, with the settings of site.yaml, again and again until Ctrl-C.
class SiteFrames final : public FrameSource {
 public:
  /// Throws InputError for a site without a camera of its own, and as open_camera().
  explicit SiteFrames(const Site& site);

  /// Waits for a frame. Nothing after Ctrl-C, and when a camera that has sent frames is silent for seconds.
  /// Throws InputError when it never sends one.
  std::optional<SourceFrame> next() override;

 private:
  [[nodiscard]] std::optional<Frame> newest();

  std::string name_;
  std::unique_ptr<Camera> camera_;
  Interruption interruption_;
  int frame_ = 0;
};

}  // namespace lodestar
