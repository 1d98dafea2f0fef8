#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace lodestar {

/// Throws InputError when the file cannot be written.
void write_png(const std::filesystem::path& file, const cv::Mat& picture);

}  // namespace lodestar
