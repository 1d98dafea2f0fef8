#include "maps/map_image.hpp"

#include <fmt/format.h>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>

#include "maps/path_kind.hpp"
#include "maps/picture.hpp"

namespace lodestar {
namespace {

std::string read_whole(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || is_folder(file)) throw PictureError("cannot be read");
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

/// The gray value as map_server computes it: the mean of the colour channels, without alpha.
std::uint8_t mean_of(const std::uint8_t* pixel, int channels) {
  if (channels < 3) return pixel[0];
  return static_cast<std::uint8_t>((pixel[0] + pixel[1] + pixel[2]) / 3);
}

}  // namespace

MapImage read_map_image(const std::filesystem::path& file) {
  const std::string bytes = read_whole(file);
  if (bytes.empty()) throw PictureError("an empty file");
  cv::Mat picture = decode_picture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
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
