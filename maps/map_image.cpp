#include "maps/map_image.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

constexpr int max_side_px = 32768;

[[noreturn]] void refuse(const std::string& reason) {
  throw std::runtime_error(reason);
}

std::string read_whole(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || is_folder(file)) refuse("cannot be read");
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

/// Reads the numbers of a portable graymap: separated by white space, comments from # to the end of the line.
class PgmReader {
 public:
  explicit PgmReader(const std::string& bytes) : bytes_(bytes), at_(2) {}

  int number(const std::string& what, int low, int high) {
    skip_space_and_comments();
    if (at_ >= bytes_.size() || !is_digit(bytes_[at_])) refuse(fmt::format("PGM without {}", what));
    long value = 0;
    while (at_ < bytes_.size() && is_digit(bytes_[at_])) {
      value = value * 10 + (bytes_[at_++] - '0');
      if (value > high) break;
    }
    if (value < low || value > high) refuse(fmt::format("PGM {} outside {} to {}", what, low, high));
    return static_cast<int>(value);
  }

  /// One white-space byte ends the header of a binary graymap.
  std::size_t start_of_binary() {
    if (at_ >= bytes_.size() || std::isspace(static_cast<unsigned char>(bytes_[at_])) == 0)
      refuse("PGM header cut short");
    return at_ + 1;
  }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }

  void skip_space_and_comments() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#') {
        at_ = std::min(bytes_.find('\n', at_), bytes_.size());
      } else if (std::isspace(static_cast<unsigned char>(bytes_[at_])) != 0) {
        ++at_;
      } else {
        return;
      }
    }
  }

  const std::string& bytes_;
  std::size_t at_;
};

std::uint8_t scaled(int value, int maximum) {
  return static_cast<std::uint8_t>(maximum == 255 ? value : (value * 255 + maximum / 2) / maximum);
}

void read_binary_pixels(const std::string& bytes, std::size_t start, int maximum, MapImage& image) {
  const std::size_t bytes_each = maximum > 255 ? 2 : 1;
  if (bytes.size() - start < image.gray.size() * bytes_each) refuse("PGM cut short");
  for (std::size_t i = 0; i < image.gray.size(); ++i) {
    int value = static_cast<unsigned char>(bytes[start + i * bytes_each]);
    if (bytes_each == 2) value = value * 256 + static_cast<unsigned char>(bytes[start + i * 2 + 1]);
    if (value > maximum) refuse(fmt::format("PGM pixel {} above its maximum {}", value, maximum));
    image.gray[i] = scaled(value, maximum);
  }
}

MapImage read_pgm(const std::string& bytes) {
  PgmReader reader(bytes);
  MapImage image;
  image.width_px = reader.number("width", 1, max_side_px);
  image.height_px = reader.number("height", 1, max_side_px);
  const int maximum = reader.number("maximum", 1, 65535);
  const auto pixels = static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
  if (bytes.size() < pixels) refuse("PGM cut short");  // before any memory is allocated
  image.gray.resize(pixels);
  if (bytes[1] == '5') {
    read_binary_pixels(bytes, reader.start_of_binary(), maximum, image);
  } else {
    for (std::uint8_t& gray : image.gray) gray = scaled(reader.number("pixel", 0, maximum), maximum);
  }
  return image;
}

/// The gray value as map_server computes it: the mean of the colour channels, without alpha.
std::uint8_t mean_of(const std::uint8_t* pixel, int channels) {
  if (channels < 3) return pixel[0];
  return static_cast<std::uint8_t>((pixel[0] + pixel[1] + pixel[2]) / 3);
}

MapImage read_with_opencv(const std::string& bytes) {
  cv::Mat picture;
  try {
    const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
    picture = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    picture = cv::Mat();
  }
  if (picture.empty()) refuse("no PGM, PNG or BMP that can be decoded");
  if (picture.depth() == CV_16U) picture.convertTo(picture, CV_8U, 1.0 / 257.0);
  if (picture.depth() != CV_8U) refuse("pixels of neither 8 nor 16 bits");

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

}  // namespace

MapImage read_map_image(const std::filesystem::path& file) {
  const std::string bytes = read_whole(file);
  if (bytes.empty()) refuse("an empty file");
  const bool is_pgm = bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == '2' || bytes[1] == '5');
  return is_pgm ? read_pgm(bytes) : read_with_opencv(bytes);
}

std::string pgm_text(const MapImage& image) {
  std::string text = fmt::format("P5\n{} {}\n255\n", image.width_px, image.height_px);
  text.append(image.gray.begin(), image.gray.end());
  return text;
}

}  // namespace lodestar
