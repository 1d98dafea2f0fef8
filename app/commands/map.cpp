#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/command.hpp"
#include "maps/map_file.hpp"
#include "maps/octomap_file.hpp"

namespace lodestar {
namespace {

struct MapArguments {
  std::string file;
  std::string output;
  bool json = false;
  double z_min_m = 0.0;
  double z_max_m = 0.0;
};

bool is_octomap(const std::filesystem::path& file) {
  return file.extension() == ".bt" || file.extension() == ".ot";
}

nlohmann::ordered_json octomap_summary(const std::filesystem::path& file) {
  const OctomapInfo info = octomap_info(file);
  return {{"kind", "octomap"},
          {"resolution_m", info.resolution_m},
          {"leaves_occupied", info.leaves_occupied},
          {"leaves_free", info.leaves_free},
          {"low_m", {info.low_m.x(), info.low_m.y(), info.low_m.z()}},
          {"high_m", {info.high_m.x(), info.high_m.y(), info.high_m.z()}}};
}

nlohmann::ordered_json grid_summary(const std::filesystem::path& file) {
  const LoadedMap loaded = load_map(file);
  for (const std::string& warning : loaded.warnings) fmt::print(stderr, "lodestar: warning: {}\n", warning);
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
    fmt::print("{}\n", summary.dump(2));
  } else {
    for (const auto& [key, value] : summary.items()) {
      fmt::print("{:<16} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
  return done;
}

ExitCode slice(const MapArguments& arguments) {
  save_map(octomap_slice(arguments.file, arguments.z_min_m, arguments.z_max_m), arguments.output);
  return done;
}

ExitCode convert(const MapArguments& arguments) {
  save_map(load_map(arguments.file).map, arguments.output);
  return done;
}

}  // namespace

std::vector<Command> map_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<MapArguments>();
  CLI::App* map = lodestar.add_subcommand("map", "Look at maps, and make floor maps of OctoMaps");
  map->require_subcommand(1);

  CLI::App* info_command = map->add_subcommand("info", "What a map file holds");
  info_command->add_option("file", arguments->file, "map_server YAML, OctoMap .bt or .ot")->required();
  info_command->add_flag("--json", arguments->json, "As JSON");

  CLI::App* slice_command =
      map->add_subcommand("slice", "Make a floor map of the voxels between two heights");
  slice_command->add_option("file", arguments->file, "OctoMap .bt or .ot")->required();
  slice_command
      ->add_option("--z-min", arguments->z_min_m, "Lower height in metres: the robot's floor clearance")
      ->required();
  slice_command->add_option("--z-max", arguments->z_max_m, "Upper height in metres: the robot's height")
      ->required();
  slice_command
      ->add_option("-o,--output", arguments->output,
                   "map_server YAML file to write; its image goes beside it")
      ->required();

  CLI::App* convert_command =
      map->add_subcommand("convert", "Write a map anew as YAML and PGM, losing nothing");
  convert_command->add_option("file", arguments->file, "map_server YAML")->required();
  convert_command->add_option("-o,--output", arguments->output, "map_server YAML file to write")->required();

  return {{info_command, [arguments] { return info(*arguments); }},
          {slice_command, [arguments] { return slice(*arguments); }},
          {convert_command, [arguments] { return convert(*arguments); }}};
}

}  // namespace lodestar
