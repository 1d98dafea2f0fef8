#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

namespace lodestar {

/// The bytes of a PNG file, or of a JPEG file of quality 75.
std::string png_bytes(const cv::Mat& picture);
std::string jpeg_bytes(const cv::Mat& picture);

/// Throws InputError when the file cannot be written.
void write_png(const std::filesystem::path& file, const cv::Mat& picture);

}  // namespace lodestar
