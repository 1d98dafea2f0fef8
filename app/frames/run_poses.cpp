#include "app/frames/run_poses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <string>
#include <string_view>

#include "app/frames/csv_numbers.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// How the header of steps.csv begins, in all versions; more columns follow.
constexpr std::string_view steps_columns = "stamp_s,x_m,y_m,yaw_deg,sigma_m,sigma_yaw_deg";
constexpr const char* tum_columns = "stamp x y z qx qy qz qw";

/// No room is so large; farther, and a position loses its millimetres.
bool is_near(double x_m, double y_m) {
  constexpr double far_m = 1e6;
  return std::abs(x_m) < far_m && std::abs(y_m) < far_m;
}

/// The cells of a line up to the comma after so many; all of it where there are no more.
std::string_view first_cells(std::string_view line, std::ptrdiff_t count) {
  std::size_t end = 0;
  for (; count > 0 && end != std::string_view::npos; --count) end = line.find(',', end + (end > 0 ? 1 : 0));
  return line.substr(0, end);
}

/// A line that was cut short has fewer cells than the header.
std::optional<RunPose> step_pose(std::string_view line, std::ptrdiff_t commas) {
  if (std::ranges::count(line, ',') != commas) return std::nullopt;
  const auto numbers = csv_numbers<6>(first_cells(line, 6));
  if (!numbers) return std::nullopt;
  const auto& [stamp_s, x_m, y_m, yaw_deg, sigma_m, sigma_yaw_deg] = *numbers;
  if (!is_stamp(stamp_s) || !is_near(x_m, y_m) || sigma_m < 0.0 || sigma_yaw_deg < 0.0) return std::nullopt;
  return RunPose{.stamp = Stamp(from_seconds(stamp_s)),
                 .map_from_base = {{x_m, y_m}, wrap_angle(radians(yaw_deg))},
                 .sigma_m = sigma_m,
                 .sigma_rad = radians(sigma_yaw_deg)};
}

/// Only its place and direction in the plane.
std::optional<RunPose> tum_pose(std::string line) {
  std::ranges::replace(line, ' ', ',');
  const auto numbers = csv_numbers<8>(line);
  if (!numbers) return std::nullopt;
  const auto& [stamp_s, x_m, y_m, z_m, qx, qy, qz, qw] = *numbers;
  constexpr double slack = 0.01;  // of a quaternion with two decimals
  const double length = std::hypot(std::hypot(qx, qy), std::hypot(qz, qw));
  if (!is_stamp(stamp_s) || !is_near(x_m, y_m) || std::abs(length - 1.0) > slack) return std::nullopt;
  const Eigen::Quaterniond rotation(qw, qx, qy, qz);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() << x_m, y_m, z_m;
  return RunPose{.stamp = Stamp(from_seconds(stamp_s)), .map_from_base = flattened(pose)};
}

std::vector<RunPose> read_steps(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<RunPose> poses;
  int number = 0;
  std::string header;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (number == 1) {
      if (!line.starts_with(steps_columns))
        throw InputError(file, 1, "'" + line + "'",
                         fmt::format("a header that begins with '{}'", steps_columns));
      header = line;
      continue;
    }
    const std::optional<RunPose> pose = step_pose(line, std::ranges::count(header, ','));
    if (!pose) throw InputError(file, number, "'" + line + "'", fmt::format("a step: {}", header));
    const bool repeats_the_last = !poses.empty() && pose->stamp <= poses.back().stamp;
    if (!repeats_the_last) poses.push_back(*pose);
  }
  return poses;
}

std::vector<RunPose> read_tum(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file, 0, "no file that can be read", "the poses of a run");
  std::vector<RunPose> poses;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty() || line.starts_with('#')) continue;
    const std::optional<RunPose> pose = tum_pose(line);
    if (!pose || (!poses.empty() && pose->stamp <= poses.back().stamp))
      throw InputError(file, number, "'" + line + "'",
                       fmt::format("a pose, in order of time: {}", tum_columns));
    poses.push_back(*pose);
  }
  return poses;
}

}  // namespace

std::vector<RunPose> load_run_poses(const fs::path& folder) {
  if (!is_folder(folder)) throw InputError(folder, 0, "no such folder", "that of a run");
  return is_file(folder / "steps.csv") ? read_steps(folder / "steps.csv") : read_tum(folder / "estimate.tum");
}

std::optional<RunPose> pose_at(std::span<const RunPose> poses, Stamp stamp, Duration most_apart) {
  const auto after = std::ranges::lower_bound(poses, stamp, {}, &RunPose::stamp);
  if (after == poses.end()) return std::nullopt;
  if (after->stamp == stamp) return *after;
  if (after == poses.begin()) return std::nullopt;
  const RunPose& before = *std::prev(after);
  if (after->stamp - before.stamp > most_apart) return std::nullopt;
  const double share = seconds(stamp - before.stamp) / seconds(after->stamp - before.stamp);
  const Pose2 from = before.map_from_base;
  const Pose2 to = after->map_from_base;
  const double turn_rad = wrap_angle(to.yaw_rad - from.yaw_rad);
  return RunPose{.stamp = stamp,
                 .map_from_base = {from.position_m + share * (to.position_m - from.position_m),
                                   wrap_angle(from.yaw_rad + share * turn_rad)},
                 .sigma_m = std::max(before.sigma_m, after->sigma_m),
                 .sigma_rad = std::max(before.sigma_rad, after->sigma_rad)};
}

}  // namespace lodestar
