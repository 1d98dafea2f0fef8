#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "localization/detected_marker.hpp"

namespace lodestar {

/// The frame in colour with each decoded marker's dots, axes (x red, y green), ID and confidence.
cv::Mat draw_markers(const cv::Mat& gray, const std::vector<DetectedMarker>& markers);

/// Writes the picture as PNG into `folder`, named after `image_file`. Throws InputError when it cannot.
void write_overlay(const std::filesystem::path& folder, const std::string& image_file,
                   const cv::Mat& picture);

}  // namespace lodestar
