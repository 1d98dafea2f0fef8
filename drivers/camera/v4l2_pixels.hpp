#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

namespace lodestar {

/// Pixel layout of a V4L2 camera.
struct V4l2Layout {
  std::uint32_t fourcc = 0;  ///< V4L2_PIX_FMT_...
  int width_px = 0;
  int height_px = 0;
  int bytes_per_line = 0;    ///< of the gray, luma or interleaved plane
  bool limited_luma = true;  ///< black is 16 and white 235, for YUV formats
};

/// The supported formats, best first: lossless gray, then formats with a luma channel, then JPEG.
std::span<const std::uint32_t> readable_v4l2_formats();

/// Those of depth cameras: Z16, sixteen bits a pixel.
std::span<const std::uint32_t> readable_v4l2_depth_formats();

/// The four characters of a format, for example "YUYV".
std::string fourcc_name(std::uint32_t fourcc);

/// A copy of the frame as 8-bit gray, made in one pass over the device's memory, which may be slow to read.
/// Empty when there are too few bytes for the layout, or when they are not a JPEG of that size. Depths stay
/// as they are (CV_16UC1).
cv::Mat gray_of(const V4l2Layout& layout, std::span<const std::uint8_t> bytes);

}  // namespace lodestar
