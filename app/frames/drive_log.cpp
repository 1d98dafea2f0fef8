#include "app/frames/drive_log.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fstream>
#include <string>

#include "app/frames/csv_numbers.hpp"
#include "app/frames/image_files.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

bool is_image_name(const fs::path& file) {
  constexpr std::array endings{".png", ".pgm", ".bmp", ".jpg", ".jpeg", ".tif", ".tiff"};
  return std::ranges::find(endings, file.extension().string()) != endings.end();
}

LoggedImage logged_image(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::optional<double> stamp_s = finite_number(stem);
  if (!stamp_s || *stamp_s < 0.0 || !is_stamp(*stamp_s)) {
    throw InputError(file, 0, "an image named '" + stem + "'", "a name that is its stamp in seconds");
  }
  return {Stamp(from_seconds(*stamp_s)), file};
}

std::vector<LoggedImage> logged_images(const fs::path& folder) {
  if (!is_folder(folder)) throw InputError(folder, 0, "no such folder", "images and wheels.csv");
  std::vector<LoggedImage> images;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && is_image_name(entry.path())) images.push_back(logged_image(entry.path()));
  }
  if (images.empty()) throw InputError(folder, 0, "a folder without images", "images named by their stamp");
  std::ranges::sort(images, {}, &LoggedImage::stamp);
  return images;
}

/// `stamp,left,right`; nothing for any other row.
std::optional<WheelTravel> wheel_row(const std::string& line) {
  const auto numbers = csv_numbers<3>(line);
  if (!numbers || !is_stamp((*numbers)[0])) return std::nullopt;
  return WheelTravel{Stamp(from_seconds((*numbers)[0])), (*numbers)[1], (*numbers)[2]};
}

}  // namespace

std::vector<WheelTravel> load_wheels(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file, 0, "no file that can be read", "the wheels' travel");
  const std::string header = "stamp_s,left_m,right_m";
  std::vector<WheelTravel> wheels;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (number == 1) {
      if (line != header) throw InputError(file, 1, "'" + line + "'", "the header '" + header + "'");
      continue;
    }
    const std::optional<WheelTravel> row = wheel_row(line);
    if (!row && stream.eof() && !wheels.empty()) break;  // a drive that was cut off leaves half a line
    if (!row) throw InputError(file, number, "'" + line + "'", "three numbers: stamp_s,left_m,right_m");
    if (!wheels.empty() && row->stamp <= wheels.back().stamp) {
      throw InputError(file, number, fmt::format("a stamp of {} s", seconds(row->stamp)),
                       fmt::format("one after {} s", seconds(wheels.back().stamp)));
    }
    wheels.push_back(*row);
  }
  if (wheels.empty()) throw InputError(file, 0, "no readings", "rows of stamp_s,left_m,right_m");
  return wheels;
}

DriveLog load_drive_log(const fs::path& folder) {
  return {.images = logged_images(folder), .wheels = load_wheels(folder / "wheels.csv")};
}

cv::Mat read_logged_image(const fs::path& file, const CameraModel& camera) {
  cv::Mat gray = read_gray(file);
  if (gray.cols != camera.width_px || gray.rows != camera.height_px) {
    throw InputError(file, 0, fmt::format("{} x {} pixels", gray.cols, gray.rows),
                     fmt::format("the camera's {} x {}", camera.width_px, camera.height_px));
  }
  return gray;
}

}  // namespace lodestar
