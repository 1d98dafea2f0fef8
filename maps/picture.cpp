#include "maps/picture.hpp"

#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "maps/path_kind.hpp"
#include "maps/picture_formats.hpp"

namespace lodestar {
namespace {

enum class PictureFormat { png, jpeg, tiff, webp, bmp, pnm, unknown };

bool begins_with(PictureBytes bytes, std::string_view magic, std::size_t at = 0) {
  if (bytes.size() < at + magic.size()) return false;
  return std::string_view(reinterpret_cast<const char*>(bytes.data()) + at, magic.size()) == magic;
}

PictureFormat format_of(PictureBytes bytes) {
  using std::string_view_literals::operator""sv;
  if (begins_with(bytes, "\x89PNG\r\n\x1a\n"sv)) return PictureFormat::png;
  if (begins_with(bytes, "\xff\xd8\xff"sv)) return PictureFormat::jpeg;
  if (begins_with(bytes, "II*\0"sv) || begins_with(bytes, "MM\0*"sv)) return PictureFormat::tiff;
  if (begins_with(bytes, "RIFF"sv) && begins_with(bytes, "WEBP"sv, 8)) return PictureFormat::webp;
  if (begins_with(bytes, "BM"sv)) return PictureFormat::bmp;
  if (begins_with(bytes, "P2"sv) || begins_with(bytes, "P5"sv) || begins_with(bytes, "P6"sv))
    return PictureFormat::pnm;
  return PictureFormat::unknown;
}

cv::Mat decode(PictureBytes bytes, bool gray) {
  if (bytes.size() > std::numeric_limits<int>::max()) throw PictureError("a file of more than 2 GB");
  switch (format_of(bytes)) {
    case PictureFormat::png:
      return decode_png(bytes);
    case PictureFormat::jpeg:
      return decode_jpeg(bytes, gray);
    case PictureFormat::tiff:
      return decode_tiff(bytes);
    case PictureFormat::webp:
      return decode_webp(bytes);
    case PictureFormat::bmp:
      return decode_bmp(bytes);
    case PictureFormat::pnm:
      return decode_pnm(bytes);
    case PictureFormat::unknown:
      break;
  }
  throw PictureError("no image that can be decoded");
}

}  // namespace

void expect_picture_size(std::int64_t width_px, std::int64_t height_px) {
  const bool fits = width_px > 0 && height_px > 0 && width_px <= max_picture_side_px &&
                    height_px <= max_picture_side_px &&
                    width_px * height_px <= static_cast<std::int64_t>(max_picture_px);
  if (!fits) throw PictureError(fmt::format("an image of {} x {} pixels", width_px, height_px));
}

cv::Mat decode_picture(std::span<const std::uint8_t> bytes) {
  return decode(bytes, false);
}

cv::Mat decode_gray(std::span<const std::uint8_t> bytes) {
  cv::Mat picture = decode(bytes, true);
  if (picture.channels() == 3) cv::cvtColor(picture, picture, cv::COLOR_BGR2GRAY);
  if (picture.channels() == 4) cv::cvtColor(picture, picture, cv::COLOR_BGRA2GRAY);
  if (picture.depth() == CV_16U) picture.convertTo(picture, CV_8U, 255.0 / 65535.0);
  return picture;
}

std::vector<std::uint8_t> picture_bytes_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = stream && !is_folder(file) ? static_cast<std::streamoff>(stream.tellg()) : -1;
  if (size < 0) throw PictureError("a file that cannot be read");
  if (size == 0) throw PictureError("an empty file");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!stream) throw PictureError("a file that cannot be read");
  return bytes;
}

cv::Mat gray_picture_in(const std::filesystem::path& file) {
  return decode_gray(picture_bytes_in(file));
}

bool begins_picture(std::span<const std::uint8_t> bytes) {
  return format_of(bytes) != PictureFormat::unknown;
}

}  // namespace lodestar
