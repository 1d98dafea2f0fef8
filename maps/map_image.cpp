#include "maps/map_image.hpp"

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "maps/picture.hpp"

namespace lodestar {
namespace {

/// The gray value as map_server computes it: the mean of the colour channels, without alpha.
std::uint8_t mean_of(const std::uint8_t* pixel, int channels) {
  if (channels < 3) return pixel[0];
  return static_cast<std::uint8_t>((pixel[0] + pixel[1] + pixel[2]) / 3);
}

}  // namespace

MapImage read_map_image(const std::filesystem::path& file) {
  cv::Mat picture = decode_picture(picture_bytes_in(file));
  if (picture.depth() == CV_16U) picture.convertTo(picture, CV_8U, 1.0 / 257.0);

  MapImage image;
  image.width_px = picture.cols;
  image.height_px = picture.rows;
  const int channels = picture.channels();
  const bool has_alpha = channels == 4;
  for (int y = 0; y < picture.rows; ++y) {
    const std::uint8_t* row = picture.ptr<std::uint8_t>(y);
    for (int x = 0; x < picture.cols; ++x) {
      const std::uint8_t* pixel = row + static_cast<std::ptrdiff_t>(x) * channels;
      image.gray.push_back(mean_of(pixel, channels));
      if (has_alpha) image.transparent.push_back(pixel[3] < 255);
    }
  }
  return image;
}

std::string pgm_text(const MapImage& image) {
  std::string text = fmt::format("P5\n{} {}\n255\n", image.width_px, image.height_px);
  text.append(image.gray.begin(), image.gray.end());
  return text;
}

}  // namespace lodestar
