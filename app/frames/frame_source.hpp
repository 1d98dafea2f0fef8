#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "maps/stamp.hpp"

namespace lodestar {

/// One frame of a source, and its name.
struct SourceFrame {
  std::string name;     ///< in results: `shots/0.5.png`; the 13th frame of a video or device is `clip.avi#12`
  std::string picture;  ///< a file name for a drawing of it, without ending: `0.5`, `clip-000012`
  bool of_sequence = false;  ///< of a video or camera: much like the frame before
  Stamp stamp;
  cv::Mat gray;  ///< CV_8UC1, never written to again: it may be kept without a copy
};

/// Image files, a video or a camera: one frame after another, so that any number of them fits in memory.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// The next frame; nothing after the last. Throws InputError when it cannot be read.
  virtual std::optional<SourceFrame> next() = 0;
};

}  // namespace lodestar
