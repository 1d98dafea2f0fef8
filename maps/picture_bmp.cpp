#include <cstdlib>
#include <memory>
#include <opencv2/imgproc.hpp>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS 32768
#include <stb/stb_image.h>

#include "maps/picture_formats.hpp"

namespace lodestar {
namespace {

std::int64_t little_endian(PictureBytes bytes, std::size_t at, int count) {
  std::int64_t value = 0;
  for (int i = count - 1; i >= 0; --i) value = value * 256 + bytes[at + static_cast<std::size_t>(i)];
  return value;
}

/// stb_image reads what is missing at the end of a BMP as black.
bool is_cut_bmp(PictureBytes bytes) {
  constexpr std::size_t header = 54;
  constexpr int signed_range_bits = 32;
  if (bytes.size() < header) return true;
  const std::int64_t pixels_at = little_endian(bytes, 10, 4);
  const std::int64_t width_px = little_endian(bytes, 18, 4);
  const std::int64_t height = little_endian(bytes, 22, 4);  // negative where the first row is the top
  const std::int64_t height_px = height >> 31 != 0 ? (std::int64_t{1} << signed_range_bits) - height : height;
  const std::int64_t bits = little_endian(bytes, 28, 2);
  expect_picture_size(width_px, height_px);
  const std::int64_t row_bytes = (width_px * bits + 31) / 32 * 4;
  return static_cast<std::int64_t>(bytes.size()) < pixels_at + row_bytes * height_px;
}

cv::Mat decode_with_stb(PictureBytes bytes) {
  int width_px = 0;
  int height_px = 0;
  int channels = 0;
  const auto size = static_cast<int>(bytes.size());
  if (stbi_info_from_memory(bytes.data(), size, &width_px, &height_px, &channels) == 0)
    throw PictureError("no image that can be decoded");
  expect_picture_size(width_px, height_px);
  const std::unique_ptr<stbi_uc, decltype(&std::free)> pixels(
      stbi_load_from_memory(bytes.data(), size, &width_px, &height_px, &channels, STBI_default), std::free);
  if (!pixels) throw PictureError("no image that can be decoded");
  const cv::Mat red_first(height_px, width_px, CV_MAKETYPE(CV_8U, channels), pixels.get());
  cv::Mat picture;
  if (channels < 3) {
    picture = red_first.clone();
  } else {
    cv::cvtColor(red_first, picture, channels == 3 ? cv::COLOR_RGB2BGR : cv::COLOR_RGBA2BGRA);
  }
  return picture;
}

}  // namespace

cv::Mat decode_bmp(PictureBytes bytes) {
  if (is_cut_bmp(bytes)) throw PictureError("a BMP image that is cut short");
  return decode_with_stb(bytes);
}

}  // namespace lodestar
