#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <set>
#include <string>
#include <vector>

#include "app/frames/frame_source.hpp"
#include "localization/detection/detected_marker.hpp"

namespace lodestar {

/// A marker of the drawing, and why it is not used ("registered twice"); empty when it is.
struct OverlayMarker {
  DetectedMarker marker;
  std::string objection;
};

/// The drawing by which a person checks a frame.
struct Overlay {
  cv::Mat gray;
  std::vector<OverlayMarker> markers;
  std::vector<std::string> words;  ///< lines below the picture; the first one is the result
  bool accepted = true;            ///< a green bar beside the words, else a red one
};

/// The frame, enlarged when it is small, with each marker's dots (circles with their centres), axes (O to X
/// red, O to Y green), ID and confidence, and the words below it.
cv::Mat draw_overlay(const Overlay& overlay);

/// Where drawings go, as PNG.
class OverlayFolder {
 public:
  /// Throws InputError when the folder cannot be created, or is one of those that hold the images themselves.
  OverlayFolder(std::filesystem::path folder, const std::vector<std::filesystem::path>& image_folders);

  /// Writes `0.5.png` or `clip-000012.png`; frames of the same name in one run become `0.5-2.png` and so on.
  /// Throws InputError when it cannot be written.
  void write(const SourceFrame& frame, const cv::Mat& picture);

 private:
  std::filesystem::path folder_;
  std::set<std::string> written_;
};

}  // namespace lodestar
