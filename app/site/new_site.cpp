#include "app/site/new_site.hpp"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fmt/format.h>
#include <regex>
#include <sys/stat.h>

#include "app/site/robot_mount.hpp"
#include "app/site/site.hpp"
#include "maps/atomic_file.hpp"
#include "maps/distance_field.hpp"
#include "maps/file_text.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// The last cell that a breadth-first search over the four neighbours reaches.
Cell farthest_from(Cell start, const DistanceField& room, double room_m) {
  const auto index = [&](Cell cell) {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(room.columns()) +
           static_cast<std::size_t>(cell.column);
  };
  std::vector<bool> seen(static_cast<std::size_t>(room.columns()) * static_cast<std::size_t>(room.rows()));
  std::deque<Cell> open{start};
  seen[index(start)] = true;
  Cell last = start;
  for (; !open.empty(); open.pop_front()) {
    last = open.front();
    for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell next{last.column + step.column, last.row + step.row};
      const bool is_inside =
          next.column >= 0 && next.row >= 0 && next.column < room.columns() && next.row < room.rows();
      if (!is_inside || seen[index(next)] || room.distance_m(next) < room_m) continue;
      seen[index(next)] = true;
      open.push_back(next);
    }
  }
  return last;
}

std::string site_text(const NewSite& site, const std::string& name, const StartAndGoal& drive) {
  return fmt::format(
      "format: lodestar-site\nversion: 1\nname: {0}{1}{0}\nmap: map.yaml\nmarkers: markers.yaml\n"
      "cameras: {{{2}: camera.yaml}}\ndefault_camera: {2}\nrobot: robot.yaml\n"
      "start: {{x_m: {3:.3f}, y_m: {4:.3f}, yaw_deg: 0}}\ngoals:\n"
      "  - {{name: far, x_m: {5:.3f}, y_m: {6:.3f}}}\n"
      "  - {{name: start, x_m: {3:.3f}, y_m: {4:.3f}}}\n"
      "camera: simulated\nbase: {{bus: socketcan:can0, protocol: {7}{8}}}\n",
      '\'', name, site.camera_profile, drive.start_m.x(), drive.start_m.y(), drive.goal_m.x(),
      drive.goal_m.y(), site.base_protocol,
      site.base_protocol == "odrive"
          ? ", wheel_diameter_m: 0.17, left_node: 0, right_node: 1, right_is_mirrored: true"
          : "");
}

/// The folder's own name, without what YAML's single quotes and lines would not carry.
std::string name_of(const fs::path& folder) {
  std::string name;
  for (const char c : folder.filename().string())
    if (c != '\'' && static_cast<unsigned char>(c) >= ' ') name += c;
  return name.empty() ? "site" : name;
}

fs::path without_slash(const fs::path& folder) {
  const fs::path normal = folder.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

/// The rest of the file, comments included, stays as it is.
void write_robot(const NewSite& site, const fs::path& file) {
  std::string text = file_text(site.robot_file, "one to begin with");
  static const std::regex radius("^radius_m:[^#\n]*", std::regex::multiline);
  if (site.radius_m) text = std::regex_replace(text, radius, fmt::format("radius_m: {}", *site.radius_m));
  write_file_atomically(file, text);
  if (site.camera_height_m)
    write_file_atomically(file, with_camera_mount(file, {{"z_m", fmt::format("{}", *site.camera_height_m)}}));
}

void write_files(const NewSite& site, const fs::path& folder, const std::string& name) {
  write_robot(site, folder / "robot.yaml");
  write_file_atomically(folder / "camera.yaml", file_text(site.camera_file, "one to begin with"));
  save_map(site.map, folder / "map.yaml", "");
  save_registry(MarkerRegistry{}, folder / "markers.yaml");
  save_places(Places{}, folder);
  const Robot robot = load_robot(folder / "robot.yaml");
  const double radius_m = robot.footprint ? robot.footprint->outer_radius_m() : robot.radius_m;
  const StartAndGoal drive = start_and_goal(site.map, radius_m + robot.preferred_clearance_m);
  write_file_atomically(folder / "site.yaml", site_text(site, name, drive));
  (void)load_site(folder);
}

}  // namespace

StartAndGoal start_and_goal(const OccupancyMap& map, double room_m) {
  const DistanceField room(map);
  // The wall's face is half a cell nearer than its centre, and a path may pass half a cell beside.
  const double wanted_m = room_m + map.resolution_m;
  Cell best{0, 0};
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column)
      if (room.squared_cells({column, row}) > room.squared_cells(best)) best = {column, row};
  if (room.distance_m(best) < wanted_m)
    throw InputError(
        fmt::format("the map: found at most {:.2f} m of room, wanted {:.2f} m for the robot; is "
                    "the scale right?",
                    room.distance_m(best), wanted_m));
  return {map.center_of(best), map.center_of(farthest_from(best, room, wanted_m))};
}

void make_site(const NewSite& site, const fs::path& folder) {
  const fs::path target = without_slash(folder);
  std::error_code cannot;
  if (fs::exists(fs::symlink_status(target, cannot)))
    throw InputError(target, 0, "something of that name", "a new folder: nothing is overwritten");
  std::string draft = target.string() + ".XXXXXX";
  if (::mkdtemp(draft.data()) == nullptr) throw InputError(target, 0, std::strerror(errno), "a new folder");
  try {
    write_files(site, draft, name_of(target));
    fs::permissions(draft, fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec |
                               fs::perms::others_read | fs::perms::others_exec);
    fs::rename(draft, target);
  } catch (const fs::filesystem_error& error) {
    fs::remove_all(draft, cannot);
    throw InputError(target, 0, error.code().message(), "a new folder");
  } catch (...) {
    fs::remove_all(draft, cannot);
    throw;
  }
}

}  // namespace lodestar
