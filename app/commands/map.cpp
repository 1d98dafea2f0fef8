#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "app/commands/commands.hpp"
#include "app/common/json_text.hpp"
#include "app/common/picture_file.hpp"
#include "app/navigation/navigation_setup.hpp"
#include "app/report/figure.hpp"
#include "app/report/visibility_figure.hpp"
#include "maps/input_error.hpp"
#include "maps/map_file.hpp"
#include "maps/octomap_file.hpp"

namespace lodestar {
namespace {

void print_warnings(const LoadedMap& loaded) {
  for (const std::string& warning : loaded.warnings) fmt::print(stderr, "lodestar: warning: {}\n", warning);
}

struct MapArguments {
  std::string file;
  std::string output;
  bool json = false;
  std::optional<double> z_min_m;
  std::optional<double> z_max_m;
  std::optional<double> clearance_m;
  std::optional<double> robot_height_m;
};

struct VisibilityArguments {
  std::string map;
  std::string markers;
  std::string camera;
  std::string mount;
  std::string octomap;
  std::string output;
  double camera_height_m = 1.1;
  std::optional<double> radius_m;
  int headings = 8;
  bool json = false;
};

bool is_octomap(const std::filesystem::path& file) {
  return file.extension() == ".bt" || file.extension() == ".ot";
}

nlohmann::ordered_json octomap_summary(const std::filesystem::path& file) {
  const Octomap octomap(file);
  const OctomapInfo info = octomap.info();
  const std::optional<double> floor_m = octomap.floor_m();
  return {{"kind", "octomap"},
          {"resolution_m", info.resolution_m},
          {"leaves_occupied", info.leaves_occupied},
          {"leaves_free", info.leaves_free},
          {"floor_m", floor_m ? nlohmann::ordered_json(*floor_m) : nlohmann::ordered_json(nullptr)},
          {"low_m", {info.low_m.x(), info.low_m.y(), info.low_m.z()}},
          {"high_m", {info.high_m.x(), info.high_m.y(), info.high_m.z()}}};
}

nlohmann::ordered_json grid_summary(const std::filesystem::path& file) {
  const LoadedMap loaded = load_map(file);
  print_warnings(loaded);
  const OccupancyMap& map = loaded.map;
  const auto unknown = std::ranges::count(map.cells, OccupancyMap::unknown);
  const auto drivable = std::ranges::count_if(map.cells, is_drivable);
  return {{"kind", "occupancy"},
          {"image", loaded.info.image.string()},
          {"columns", map.columns},
          {"rows", map.rows},
          {"resolution_m", map.resolution_m},
          {"width_m", map.columns * map.resolution_m},
          {"height_m", map.rows * map.resolution_m},
          {"origin_x_m", map.map_from_grid.position_m.x()},
          {"origin_y_m", map.map_from_grid.position_m.y()},
          {"origin_yaw_deg", degrees(map.map_from_grid.yaw_rad)},
          {"cells_free", drivable},
          {"cells_occupied", static_cast<std::ptrdiff_t>(map.cells.size()) - drivable - unknown},
          {"cells_unknown", unknown}};
}

ExitCode info(const MapArguments& arguments) {
  const auto summary =
      is_octomap(arguments.file) ? octomap_summary(arguments.file) : grid_summary(arguments.file);
  if (arguments.json) {
    fmt::print("{}", json_document(summary));
  } else {
    for (const auto& [key, value] : summary.items()) {
      fmt::print("{:<16} {}\n", key, value.is_string() ? value.get<std::string>() : json_text(value));
    }
  }
  return done;
}

/// The slab's heights as given, or relative to the floor detected in the OctoMap.
std::pair<double, double> slab_m(const Octomap& octomap, const MapArguments& arguments) {
  const std::optional<double> floor_m = octomap.floor_m();
  if (arguments.z_min_m) {
    if (floor_m && *arguments.z_min_m < *floor_m) {
      fmt::print(
          stderr,
          "lodestar: warning: {}: the slab begins at {:g} m, below the floor at {:g} m, which becomes an "
          "obstacle; --clearance leaves it out\n",
          arguments.file, *arguments.z_min_m, *floor_m);
    }
    return {*arguments.z_min_m, *arguments.z_max_m};
  }
  if (!floor_m) {
    throw InputError(arguments.file, 0, "no floor with free air above it",
                     "one, or --z-min and --z-max for its heights");
  }
  fmt::print(stderr, "floor at {:g} m\n", *floor_m);
  return {*floor_m + *arguments.clearance_m, *floor_m + *arguments.robot_height_m};
}

ExitCode slice(const MapArguments& arguments) {
  const Octomap octomap(arguments.file);
  const auto [z_min_m, z_max_m] = slab_m(octomap, arguments);
  save_map(octomap.slice(z_min_m, z_max_m), arguments.output);
  return done;
}

VisibilityOptions visibility_options(const VisibilityArguments& arguments) {
  VisibilityOptions options;
  if (arguments.mount.empty()) {
    options.base_from_camera.translation().z() = arguments.camera_height_m;
    options.fix.prior.tilt_sigma_rad = 0.0;
    options.fix.prior.height_m = arguments.camera_height_m;
  } else {
    options = visibility_options(load_robot(arguments.mount));
  }
  options.headings = arguments.headings;
  options.robot_radius_m = arguments.radius_m.value_or(options.robot_radius_m);
  return options;
}

nlohmann::ordered_json as_json(const VisibilitySummary& summary) {
  const auto scaled = [](const std::optional<double>& value, double scale) {
    return value ? nlohmann::ordered_json(scale * *value) : nlohmann::ordered_json(nullptr);
  };
  return {{"cells", summary.cells},
          {"share_one", summary.share_one},
          {"share_two", summary.share_two},
          {"share_some_heading", summary.share_some_heading},
          {"largest_gap_m", summary.largest_gap_m},
          {"gap_x_m", summary.gap_at_m.x()},
          {"gap_y_m", summary.gap_at_m.y()},
          {"cells_cut_off", summary.cells_cut_off},
          {"position_sigma_p50_m", scaled(summary.position_sigma_p50_m, 1.0)},
          {"position_sigma_p95_m", scaled(summary.position_sigma_p95_m, 1.0)},
          {"heading_sigma_p95_deg", scaled(summary.heading_sigma_p95_rad, degrees(1.0))}};
}

void print_summary(const VisibilitySummary& summary) {
  fmt::print(
      "{} free cells; of these see, at every heading, a marker {:.1f} %, two {:.1f} %; at some heading a "
      "marker {:.1f} %\n",
      summary.cells, 100.0 * summary.share_one, 100.0 * summary.share_two,
      100.0 * summary.share_some_heading);
  fmt::print("longest way to a cell that sees one: {:.2f} m, from ({:.2f}, {:.2f})\n", summary.largest_gap_m,
             summary.gap_at_m.x(), summary.gap_at_m.y());
  if (summary.cells_cut_off > 0) fmt::print("{} cells have no way to such a cell\n", summary.cells_cut_off);
  if (!summary.position_sigma_p50_m) return;
  fmt::print(
      "standard deviation of one fix: position {:.1f} mm (95 %: {:.1f} mm), heading {:.2f} deg (95 %)\n",
      1000.0 * *summary.position_sigma_p50_m, 1000.0 * *summary.position_sigma_p95_m,
      degrees(*summary.heading_sigma_p95_rad));
}

ExitCode visibility(const VisibilityArguments& arguments) {
  const LoadedMap loaded = load_map(arguments.map);
  print_warnings(loaded);
  const MarkerRegistry registry = load_registry(arguments.markers);
  const CameraModel camera = load_camera(arguments.camera);
  std::optional<SightLines> sight_lines;
  if (!arguments.octomap.empty()) sight_lines.emplace(arguments.octomap);
  const Visibility result = visibility_of(loaded.map, registry, camera, sight_lines ? &*sight_lines : nullptr,
                                          visibility_options(arguments));
  const VisibilitySummary summary = summarize(result);
  if (!arguments.output.empty()) write_png(arguments.output, draw_visibility(result, registry));
  if (arguments.json) {
    fmt::print("{}", json_document(as_json(summary)));
  } else {
    print_summary(summary);
  }
  return done;
}

ExitCode convert(const MapArguments& arguments) {
  const LoadedMap loaded = load_map(arguments.file);
  print_warnings(loaded);
  save_map(loaded.map, arguments.output, loaded.info.other_keys);
  return done;
}

}  // namespace

std::vector<Command> map_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<MapArguments>();
  CLI::App* map =
      lodestar.add_subcommand("map", "Inspect and convert maps, and slice OctoMaps into floor maps");
  map->require_subcommand(1);

  CLI::App* info_command = map->add_subcommand("info", "Summary of a map file");
  info_command->add_option("file", arguments->file, "map_server YAML, OctoMap .bt or .ot")->required();
  info_command->add_flag("--json", arguments->json, "As JSON");

  CLI::App* slice_command =
      map->add_subcommand("slice", "Project the voxels between two heights to a floor map");
  slice_command->add_option("file", arguments->file, "OctoMap .bt or .ot")->required();
  CLI::Option* z_min = slice_command->add_option("--z-min", arguments->z_min_m,
                                                 "Lower height in metres, in the OctoMap's frame");
  CLI::Option* z_max =
      slice_command->add_option("--z-max", arguments->z_max_m, "Upper height in metres")->needs(z_min);
  z_min->needs(z_max);
  CLI::Option* clearance =
      slice_command
          ->add_option("--clearance", arguments->clearance_m,
                       "Instead: height in metres above the detected floor that the robot drives over")
          ->excludes(z_min);
  CLI::Option* height =
      slice_command
          ->add_option("--robot-height", arguments->robot_height_m, "Its height in metres above the floor")
          ->needs(clearance);
  clearance->needs(height);
  slice_command->callback([z_min, clearance] {
    if (z_min->empty() && clearance->empty())
      throw CLI::RequiredError("--z-min and --z-max, or --clearance and --robot-height");
  });
  slice_command
      ->add_option("-o,--output", arguments->output,
                   "map_server YAML file to write; its image goes beside it")
      ->required();

  CLI::App* convert_command = map->add_subcommand("convert", "Rewrite a map as YAML and PGM without loss");
  convert_command->add_option("file", arguments->file, "map_server YAML")->required();
  convert_command->add_option("-o,--output", arguments->output, "map_server YAML file to write")->required();

  const auto seen = std::make_shared<VisibilityArguments>();
  CLI::App* visibility_command = map->add_subcommand(
      "visibility", "Markers in view from each free cell, and the standard deviations of a fix there");
  visibility_command->add_option("--map", seen->map, "map_server YAML")->required();
  visibility_command->add_option("--markers", seen->markers, "Marker registry")->required();
  visibility_command->add_option("--camera", seen->camera, "Camera file")->required();
  CLI::Option* mount = visibility_command->add_option(
      "--mount", seen->mount,
      "robot.yaml with the camera's mount and its tilt sigma; default: exactly upright");
  visibility_command
      ->add_option("--camera-height", seen->camera_height_m, "Metres above the floor, without --mount")
      ->check(CLI::PositiveNumber)
      ->excludes(mount)
      ->capture_default_str();
  visibility_command->add_option("--octomap", seen->octomap,
                                 "OctoMap .bt or .ot: its occupied voxels hide markers");
  visibility_command
      ->add_option("--radius", seen->radius_m, "Robot's radius in metres: skips cells where it has no room")
      ->check(CLI::NonNegativeNumber);
  visibility_command->add_option("--headings", seen->headings, "Headings evaluated in each cell")
      ->check(CLI::Range(1, 360))
      ->capture_default_str();
  visibility_command->add_option("-o,--output", seen->output, "PNG file for a picture of the map");
  visibility_command->add_flag("--json", seen->json, "As JSON");

  return {{visibility_command, [seen] { return visibility(*seen); }},
          {info_command, [arguments] { return info(*arguments); }},
          {slice_command, [arguments] { return slice(*arguments); }},
          {convert_command, [arguments] { return convert(*arguments); }},
          map_build_command(*map)};
}

}  // namespace lodestar
