#include "drivers/camera/v4l2_pixels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <linux/videodev2.h>
#include <opencv2/core.hpp>

#include "maps/picture.hpp"

namespace lodestar {
namespace {

constexpr std::array<std::uint32_t, 11> formats{V4L2_PIX_FMT_GREY,  V4L2_PIX_FMT_Y16,    V4L2_PIX_FMT_Y12,
                                                V4L2_PIX_FMT_Y10,   V4L2_PIX_FMT_YUYV,   V4L2_PIX_FMT_UYVY,
                                                V4L2_PIX_FMT_NV12,  V4L2_PIX_FMT_YUV420, V4L2_PIX_FMT_YVU420,
                                                V4L2_PIX_FMT_MJPEG, V4L2_PIX_FMT_JPEG};

constexpr std::array<std::uint32_t, 1> depth_formats{V4L2_PIX_FMT_Z16};

using Levels = std::array<std::uint8_t, 256>;

/// Gray value of a luma value: limited range 16..235 becomes 0..255 (ITU-R BT.601); full range stays as it
/// is.
Levels levels_of(bool limited_luma) {
  Levels levels{};
  for (int i = 0; i < 256; ++i) {
    const double gray = limited_luma ? (i - 16) * 255.0 / 219.0 : i;
    levels[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(std::lround(std::clamp(gray, 0.0, 255.0)));
  }
  return levels;
}

/// Bytes per pixel in the plane that holds the luma.
int bytes_per_pixel(std::uint32_t fourcc) {
  switch (fourcc) {
    case V4L2_PIX_FMT_Y16:
    case V4L2_PIX_FMT_Y12:
    case V4L2_PIX_FMT_Y10:
    case V4L2_PIX_FMT_Z16:
    case V4L2_PIX_FMT_YUYV:
    case V4L2_PIX_FMT_UYVY:
      return 2;
    default:
      return 1;
  }
}

cv::Mat decoded_jpeg(const V4l2Layout& layout, std::span<const std::uint8_t> bytes) {
  try {
    cv::Mat gray = decode_gray(bytes);
    if (gray.cols == layout.width_px && gray.rows == layout.height_px) return gray;
  } catch (const PictureError&) {
    return {};
  }
  return {};
}

/// Converts one row to gray. Samples of 10 and 12 bits are stored in the low bits of 16, low byte first.
void convert_row(std::uint32_t fourcc, const Levels& levels, const std::uint8_t* from,
                 std::span<std::uint8_t> to) {
  const auto sixteen_bits = [&](unsigned shift) {
    for (std::size_t i = 0; i < to.size(); ++i) {
      const unsigned value = from[2 * i] | (static_cast<unsigned>(from[2 * i + 1]) << 8U);
      to[i] = static_cast<std::uint8_t>(std::min(value >> shift, 255U));
    }
  };
  const auto luma = [&](std::size_t first, std::size_t step) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = levels[from[first + step * i]];
  };
  switch (fourcc) {
    case V4L2_PIX_FMT_Y16:
      return sixteen_bits(8);
    case V4L2_PIX_FMT_Y12:
      return sixteen_bits(4);
    case V4L2_PIX_FMT_Y10:
      return sixteen_bits(2);
    case V4L2_PIX_FMT_YUYV:
      return luma(0, 2);
    case V4L2_PIX_FMT_UYVY:
      return luma(1, 2);
    case V4L2_PIX_FMT_GREY:
      std::copy_n(from, to.size(), to.begin());
      return;
    default:  // planar YUV: the luma plane comes first
      return luma(0, 1);
  }
}

/// Low byte first.
cv::Mat depths_of(const V4l2Layout& layout, std::span<const std::uint8_t> bytes, std::size_t stride) {
  cv::Mat depth(layout.height_px, layout.width_px, CV_16UC1);
  for (int y = 0; y < layout.height_px; ++y) {
    const std::uint8_t* from = bytes.data() + static_cast<std::size_t>(y) * stride;
    auto* to = depth.ptr<std::uint16_t>(y);
    for (int x = 0; x < layout.width_px; ++x)
      to[x] = static_cast<std::uint16_t>(from[2 * x] | (static_cast<unsigned>(from[2 * x + 1]) << 8U));
  }
  return depth;
}

}  // namespace

std::span<const std::uint32_t> readable_v4l2_formats() {
  return formats;
}

std::span<const std::uint32_t> readable_v4l2_depth_formats() {
  return depth_formats;
}

std::string fourcc_name(std::uint32_t fourcc) {
  std::string name;
  for (const unsigned shift : {0U, 8U, 16U, 24U})
    name.push_back(static_cast<char>((fourcc >> shift) & 0x7fU));
  return name;
}

cv::Mat gray_of(const V4l2Layout& layout, std::span<const std::uint8_t> bytes) {
  if (layout.fourcc == V4L2_PIX_FMT_MJPEG || layout.fourcc == V4L2_PIX_FMT_JPEG)
    return decoded_jpeg(layout, bytes);
  const auto row_bytes = static_cast<std::size_t>(layout.width_px * bytes_per_pixel(layout.fourcc));
  const auto stride = std::max(static_cast<std::size_t>(layout.bytes_per_line), row_bytes);
  const auto rows = static_cast<std::size_t>(layout.height_px);
  if (rows == 0 || bytes.size() < (rows - 1) * stride + row_bytes) return {};
  if (layout.fourcc == V4L2_PIX_FMT_Z16) return depths_of(layout, bytes, stride);
  const Levels levels = levels_of(layout.limited_luma);
  cv::Mat gray(layout.height_px, layout.width_px, CV_8UC1);
  for (int row = 0; row < layout.height_px; ++row) {
    convert_row(layout.fourcc, levels, bytes.data() + static_cast<std::size_t>(row) * stride,
                {gray.ptr<std::uint8_t>(row), static_cast<std::size_t>(layout.width_px)});
  }
  return gray;
}

}  // namespace lodestar
