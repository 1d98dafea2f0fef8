#include <cctype>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <string>

#include "maps/picture_formats.hpp"

namespace lodestar {
namespace {

[[noreturn]] void refuse(const std::string& reason) {
  throw PictureError(reason);
}

/// Reads the numbers of a portable graymap or pixmap: separated by white space, comments from # to the end of
/// the line.
class PnmReader {
 public:
  explicit PnmReader(PictureBytes bytes) : bytes_(bytes) {}

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

  /// One white-space byte ends the header of a binary one.
  std::size_t start_of_binary() {
    if (at_ >= bytes_.size() || std::isspace(bytes_[at_]) == 0) refuse("PGM header cut short");
    return at_ + 1;
  }

 private:
  static bool is_digit(std::uint8_t c) { return c >= '0' && c <= '9'; }

  void skip_space_and_comments() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#') {
        while (at_ < bytes_.size() && bytes_[at_] != '\n') ++at_;
      } else if (std::isspace(bytes_[at_]) != 0) {
        ++at_;
      } else {
        return;
      }
    }
  }

  PictureBytes bytes_;
  std::size_t at_ = 2;
};

std::uint8_t scaled(int value, int maximum) {
  return static_cast<std::uint8_t>(maximum == 255 ? value : (value * 255 + maximum / 2) / maximum);
}

void read_binary_samples(PictureBytes bytes, int maximum, std::span<std::uint8_t> values) {
  const std::size_t bytes_each = maximum > 255 ? 2 : 1;
  if (bytes.size() < values.size() * bytes_each) refuse("PGM cut short");
  for (std::size_t i = 0; i < values.size(); ++i) {
    int value = bytes[i * bytes_each];
    if (bytes_each == 2) value = value * 256 + bytes[i * 2 + 1];
    if (value > maximum) refuse(fmt::format("PGM pixel {} above its maximum {}", value, maximum));
    values[i] = scaled(value, maximum);
  }
}

}  // namespace

cv::Mat decode_pnm(PictureBytes bytes) {
  PnmReader reader(bytes);
  const int width_px = reader.number("width", 1, max_picture_side_px);
  const int height_px = reader.number("height", 1, max_picture_side_px);
  const int maximum = reader.number("maximum", 1, 65535);
  expect_picture_size(width_px, height_px);
  const bool is_colour = bytes[1] == '6';
  const std::size_t samples =
      static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * (is_colour ? 3 : 1);
  if (bytes.size() < samples) refuse("PGM cut short");  // before any memory is allocated
  cv::Mat picture(height_px, width_px, is_colour ? CV_8UC3 : CV_8UC1);
  const std::span<std::uint8_t> values(picture.data, samples);
  if (bytes[1] == '2') {
    for (std::uint8_t& value : values) value = scaled(reader.number("pixel", 0, maximum), maximum);
  } else {
    read_binary_samples(bytes.subspan(reader.start_of_binary()), maximum, values);
  }
  if (is_colour) cv::cvtColor(picture, picture, cv::COLOR_RGB2BGR);
  return picture;
}

}  // namespace lodestar
