#include "app/frames/survey_log_file.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>

#include "app/frames/csv_numbers.hpp"
#include "app/frames/drive_log.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr const char* header = "stamp_s,id,dot,u_px,v_px,sigma_px";

struct DotRow {
  Stamp stamp;
  int id = 0;
  MarkerDot dot;
};

bool is_whole(double value, int low, int high) {
  return value == std::floor(value) && value >= low && value <= high;
}

/// Nothing for what is no dot of a marker.
std::optional<DotRow> dot_row(const std::string& line, const CameraModel& camera) {
  const auto numbers = csv_numbers<6>(line);
  if (!numbers) return std::nullopt;
  const auto& [stamp_s, id, cell, u_px, v_px, sigma_px] = *numbers;
  constexpr int cells = marker_grid_size * marker_grid_size;
  if (!is_stamp(stamp_s) || !is_whole(id, 0, marker_id_count - 1) || !is_whole(cell, 0, cells - 1) ||
      sigma_px < 0.0 || !camera.contains({u_px, v_px}))
    return std::nullopt;
  const GridCell at{static_cast<int>(cell) / marker_grid_size, static_cast<int>(cell) % marker_grid_size};
  if (!has_dot(static_cast<int>(id), at)) return std::nullopt;
  return DotRow{Stamp(from_seconds(stamp_s)), static_cast<int>(id), {at, {u_px, v_px}, sigma_px}};
}

/// Adds a row to the frame of its stamp and the marker of its ID, which rows of one frame may mix. An ID
/// whose dot comes again is there twice: neither is known by it.
void add(const DotRow& row, std::vector<SurveyFrame>& frames, const fs::path& file, int line) {
  if (frames.empty() || row.stamp > frames.back().stamp) frames.push_back({.stamp = row.stamp});
  if (row.stamp < frames.back().stamp)
    throw InputError(file, line, fmt::format("a stamp of {} s", seconds(row.stamp)),
                     fmt::format("none before {} s", seconds(frames.back().stamp)));
  std::vector<SightedMarker>& markers = frames.back().markers;
  const auto has_cell = [&row](const SightedMarker& marker) {
    return marker.id == row.id &&
           std::ranges::find(marker.dots, row.dot.cell, &MarkerDot::cell) != marker.dots.end();
  };
  auto marker = std::ranges::find_if(
      markers, [&](const SightedMarker& known) { return known.id == row.id && !has_cell(known); });
  if (marker == markers.end()) marker = markers.insert(markers.end(), {.id = row.id});
  marker->dots.push_back(row.dot);
}

std::vector<SurveyFrame> read_dots(const fs::path& file, const CameraModel& camera) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file, 0, "no file that can be read", "dots of markers");
  std::vector<SurveyFrame> frames;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (number == 1) {
      if (line != header) throw InputError(file, 1, "'" + line + "'", fmt::format("the header '{}'", header));
      continue;
    }
    const std::optional<DotRow> row = dot_row(line, camera);
    if (!row) {
      if (stream.eof()) break;  // a drive that was cut off leaves half a line
      throw InputError(file, number, "'" + line + "'",
                       fmt::format("a dot of a marker in the camera's frame: {}", header));
    }
    add(*row, frames, file, number);
  }
  return frames;
}

/// Nothing for what is no motion of the ceiling.
std::optional<VisualOdometryIncrement> ceiling_row(const std::string& line) {
  const auto numbers = csv_numbers<12>(line);
  if (!numbers) return std::nullopt;
  const auto& [from_s, to_s, x_m, y_m, yaw_deg, xx, xy, xyaw, yy, yyaw, yawyaw, sway_m] = *numbers;
  constexpr double far_m = 100.0;
  if (!is_stamp(from_s) || !is_stamp(to_s) || to_s <= from_s || std::abs(x_m) > far_m ||
      std::abs(y_m) > far_m || std::abs(yaw_deg) > 360.0 || sway_m < 0.0 || sway_m > far_m)
    return std::nullopt;
  VisualOdometryIncrement motion{.from = Stamp(from_seconds(from_s)),
                                 .to = Stamp(from_seconds(to_s)),
                                 .then_from_now = {{x_m, y_m}, radians(yaw_deg)},
                                 .sway_m = sway_m};
  motion.covariance << xx, xy, xyaw, xy, yy, yyaw, xyaw, yyaw, yawyaw;
  const bool is_possible =
      motion.covariance.llt().info() == Eigen::Success && motion.covariance.trace() < 1.0;
  return is_possible ? std::optional(motion) : std::nullopt;
}

std::vector<VisualOdometryIncrement> read_ceiling(const fs::path& file) {
  constexpr const char* columns = "from_s,to_s,x_m,y_m,yaw_deg,xx,xy,xyaw,yy,yyaw,yawyaw,sway_m";
  std::vector<VisualOdometryIncrement> motions;
  std::ifstream stream(file);
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (number == 1) {
      if (line != columns)
        throw InputError(file, 1, "'" + line + "'", fmt::format("the header '{}'", columns));
      continue;
    }
    const std::optional<VisualOdometryIncrement> motion = ceiling_row(line);
    if (!motion && stream.eof()) break;  // cut off
    if (!motion || (!motions.empty() && motion->to <= motions.back().to))
      throw InputError(file, number, "'" + line + "'",
                       fmt::format("a motion of the ceiling, in order of time: {}", columns));
    motions.push_back(*motion);
  }
  return motions;
}

std::vector<SurveyFrame> read_images(const std::vector<LoggedImage>& images, const CameraModel& camera,
                                     const DetectorOptions& options) {
  MarkerDetector detector(options);
  std::vector<SurveyFrame> frames;
  for (const LoggedImage& image : images) {
    SurveyFrame frame{.stamp = image.stamp};
    for (const DetectedMarker& marker : detector.detect(read_logged_image(image.file, camera)))
      frame.markers.push_back({.id = marker.id, .dots = marker.dots});
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace

SurveyLog load_survey_log(const fs::path& folder, const CameraModel& camera,
                          const DetectorOptions& of_images) {
  if (!is_folder(folder)) throw InputError(folder, 0, "no such folder", "a run, or images and wheels.csv");
  SurveyLog log{.name = fs::absolute(folder).lexically_normal().filename().string()};
  if (log.name.empty()) log.name = fs::absolute(folder).lexically_normal().parent_path().filename().string();
  if (is_file(folder / "dots.csv")) {
    log.wheels = load_wheels(folder / "wheels.csv");
    log.frames = read_dots(folder / "dots.csv", camera);
    if (is_file(folder / "ceiling.csv")) log.ceiling = read_ceiling(folder / "ceiling.csv");
  } else {
    DriveLog drive = load_drive_log(folder);
    log.wheels = std::move(drive.wheels);
    log.frames = read_images(drive.images, camera, of_images);
  }
  return log;
}

}  // namespace lodestar
