#pragma once

#include <optional>
#include <string>

#include "localization/detection/marker_detector.hpp"
#include "maps/frame.hpp"

namespace lodestar {

/// Frames as sent to the page: a JPEG and the markers detected in it.
class CameraPicture {
 public:
  explicit CameraPicture(const MarkerRegistry& registry) : detector_(expecting(registry)) {}

  /// The length of the following JSON (4 bytes, little endian), {"time_s", "width_px", "height_px",
  /// "markers": [{"id", "confidence", "o_px", "x_px", "y_px", "dots_px"}]}, and the frame as JPEG. Nothing
  /// for an empty frame or one that is not 8-bit gray.
  std::optional<std::string> message(const Frame& frame);

 private:
  MarkerDetector detector_;
};

}  // namespace lodestar
