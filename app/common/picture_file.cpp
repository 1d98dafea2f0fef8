#include "app/common/picture_file.hpp"

#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "maps/atomic_file.hpp"

namespace lodestar {

std::string png_bytes(const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  return {bytes.begin(), bytes.end()};
}

std::string jpeg_bytes(const cv::Mat& picture) {
  constexpr int quality = 75;
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return {bytes.begin(), bytes.end()};
}

void write_png(const std::filesystem::path& file, const cv::Mat& picture) {
  write_file_atomically(file, png_bytes(picture));
}

}  // namespace lodestar
