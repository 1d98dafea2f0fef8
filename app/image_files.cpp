#include "app/image_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

bool has_image_ending(const fs::path& file) {
  constexpr std::array endings{".png", ".pgm", ".bmp", ".jpg", ".jpeg", ".tif", ".tiff"};
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(endings, ending) != endings.end();
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && has_image_ending(entry.path())) files.push_back(entry.path());
  }
  if (files.empty())
    throw InputError(folder, 0, "a folder without images", "PNG, PGM, BMP, JPEG or TIFF files");
  std::ranges::sort(files);
  return files;
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

cv::Mat read_gray(const fs::path& file) {
  cv::Mat gray;
  try {
    gray = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    gray = cv::Mat();  // the decoder's own words tell nothing that the line below does not
  }
  if (gray.empty()) throw InputError(file, 0, "no image that can be decoded", "PNG, PGM, BMP, JPEG or TIFF");
  return gray;
}

}  // namespace

ImageFiles::ImageFiles(const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    const fs::path path(argument);
    if (!fs::exists(path))
      throw InputError(path, 0, "no such file or folder", "an image or a folder of images");
    if (!fs::is_directory(path)) {
      files_.push_back(path);
      continue;
    }
    for (fs::path& file : images_in(path)) files_.push_back(std::move(file));
  }
  if (files_.empty()) throw InputError("found no image, wanted an image or a folder of images");
}

std::optional<ImageFile> ImageFiles::next(const std::optional<CameraModel>& camera) {
  if (next_ == files_.size()) return std::nullopt;
  const fs::path& file = files_[next_];
  const double stamp_s = seconds_in_name(file).value_or(static_cast<double>(next_));
  ++next_;
  cv::Mat gray = read_gray(file);
  if (camera && (gray.cols != camera->width_px || gray.rows != camera->height_px)) {
    throw InputError(file, 0, fmt::format("{} x {} pixels", gray.cols, gray.rows),
                     fmt::format("the camera's {} x {}", camera->width_px, camera->height_px));
  }
  return ImageFile{.file = file.string(), .stamp = Stamp(from_seconds(stamp_s)), .gray = std::move(gray)};
}

}  // namespace lodestar
