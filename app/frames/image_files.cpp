#include "app/frames/image_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <opencv2/core.hpp>
#include <string_view>

#include "maps/input_error.hpp"
#include "maps/picture.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr const char* readable_images = "PNG, PGM, BMP, JPEG, TIFF or WebP";

bool has_image_ending(const fs::path& file) {
  constexpr std::array endings{".png", ".pgm", ".bmp", ".jpg", ".jpeg", ".tif", ".tiff", ".webp"};
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(endings, ending) != endings.end();
}

std::optional<double> seconds_in_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  double value = 0.0;
  const auto [rest, error] = std::from_chars(stem.data(), stem.data() + stem.size(), value);
  constexpr double far_future_s = 9e9;
  const bool usable =
      error == std::errc() && rest == stem.data() + stem.size() && value >= 0.0 && value < far_future_s;
  return usable ? std::optional(value) : std::nullopt;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Takes a run of digits off the front, without leading zeros.
std::string_view take_number(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
  std::string_view number = text.substr(0, end);
  text.remove_prefix(end);
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

/// frame2 comes before frame10.
bool comes_before(const fs::path& left, const fs::path& right) {
  const std::string a_name = left.string();
  const std::string b_name = right.string();
  std::string_view a = a_name;
  std::string_view b = b_name;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view number_a = take_number(a);
      const std::string_view number_b = take_number(b);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
      continue;
    }
    if (a.front() != b.front()) return a.front() < b.front();
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return a_name < b_name;  // they differ in leading zeros at most
}

/// Does a JPEG file end before its end marker? The decoder fills what is missing with gray and reports
/// nothing. A file is a sequence of segments with their lengths, and of pixel data in which 0xff is followed
/// by 0 or a restart marker.
bool is_cut_jpeg(const std::vector<std::uint8_t>& bytes) {
  if (bytes.size() < 2 || bytes[0] != 0xff || bytes[1] != 0xd8) return false;
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    const std::uint8_t marker = bytes[at + 1];
    if (bytes[at] != 0xff || marker == 0xff) {
      ++at;
    } else if (marker == 0xd9) {
      return false;
    } else if (marker == 0x00 || marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8)) {
      at += 2;
    } else if (at + 3 < bytes.size()) {
      at += 2 + (std::size_t{bytes[at + 2]} << 8U | bytes[at + 3]);
    } else {
      return true;
    }
  }
  return true;
}

}  // namespace

bool is_image(const fs::path& file) {
  if (has_image_ending(file)) return true;
  std::array<char, 16> head{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), head.size());
  return begins_picture(
      {reinterpret_cast<const std::uint8_t*>(head.data()), static_cast<std::size_t>(stream.gcount())});
}

void sort_as_taken(std::vector<fs::path>& files) {
  const auto has_time = [](const fs::path& file) { return seconds_in_name(file).has_value(); };
  if (std::ranges::all_of(files, has_time)) {
    std::ranges::stable_sort(files, {}, [](const fs::path& file) { return *seconds_in_name(file); });
  } else {
    std::ranges::sort(files, comes_before);
  }
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (at->is_regular_file() && has_image_ending(at->path())) files.push_back(at->path());
  }
  if (error) throw InputError(folder, 0, "a folder that cannot be read", "a folder of images");
  if (files.empty()) {
    throw InputError(folder, 0, "a folder without images", fmt::format("{} files", readable_images));
  }
  sort_as_taken(files);
  return files;
}

cv::Mat read_gray(const fs::path& file) {
  try {
    const std::vector<std::uint8_t> bytes = picture_bytes_in(file);
    cv::Mat gray = decode_gray(bytes);
    if (is_cut_jpeg(bytes)) throw PictureError("a JPEG image that is cut short");
    return gray;
  } catch (const PictureError& error) {
    throw InputError(file, 0, error.what(), fmt::format("{} of 8 or 16 bits a pixel", readable_images));
  }
}

std::optional<SourceFrame> ImageFiles::next() {
  if (next_ == files_.size()) return std::nullopt;
  const fs::path& file = files_[next_];
  const double stamp_s = seconds_in_name(file).value_or(static_cast<double>(first_place_ + next_));
  ++next_;
  return SourceFrame{.name = file.string(),
                     .picture = file.stem().string(),
                     .stamp = Stamp(from_seconds(stamp_s)),
                     .gray = read_gray(file)};
}

}  // namespace lodestar
