#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

namespace lodestar {

/// How a V4L2 camera lays out its pixels.
struct V4l2Layout {
  std::uint32_t fourcc = 0;  ///< V4L2_PIX_FMT_...
  int width_px = 0;
  int height_px = 0;
  int bytes_per_line = 0;    ///< of the gray or luma plane, or the interleaved one
  bool limited_luma = true;  ///< black is 16 and white 235, for YUV formats
};

/// The formats that can be read, the best first: gray without loss, then luma beside colour, then JPEG.
std::span<const std::uint32_t> readable_v4l2_formats();

/// "YUYV".
std::string fourcc_name(std::uint32_t fourcc);

/// The frame as 8-bit gray, in memory of its own: one pass over the device's memory, which may be slow to
/// read twice. Empty when the bytes are too few for the layout, or no JPEG of its size.
cv::Mat gray_of(const V4l2Layout& layout, std::span<const std::uint8_t> bytes);

}  // namespace lodestar
