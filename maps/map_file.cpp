#include "maps/map_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <set>

#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"
#include "maps/map_image.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

// The gray values that map_saver writes, and thresholds that read them back: (255 - 205) / 255 = 0.19608 is
// just above the free threshold of 0.196, so 205 is read as unknown.
constexpr std::uint8_t saved_free = 254;
constexpr std::uint8_t saved_occupied = 0;
constexpr std::uint8_t saved_unknown = 205;
constexpr double saved_occupied_threshold = 0.65;
constexpr double saved_free_threshold = 0.196;
constexpr std::uint8_t raw_unknown = 255;

MapMode read_mode(StrictYaml& yaml) {
  if (!yaml.has("mode")) return MapMode::trinary;
  const std::string mode = yaml.text("mode");
  if (mode == "trinary") return MapMode::trinary;
  if (mode == "scale") return MapMode::scale;
  if (mode == "raw") return MapMode::raw;
  yaml.refuse("mode", "'" + mode + "'", "trinary, scale or raw");
}

/// The image as the YAML file names it: beside it, absolute, or in the home folder.
fs::path resolved(const std::string& name, const fs::path& yaml_file) {
  const char* home = std::getenv("HOME");
  if (name.starts_with("~/") && home != nullptr) return fs::path(home) / name.substr(2);
  return yaml_file.parent_path() / name;
}

MapFileInfo read_info(StrictYaml& yaml) {
  MapFileInfo info;
  info.image = resolved(yaml.text("image"), yaml.file());
  info.mode = read_mode(yaml);
  info.negate = yaml.boolean("negate");
  info.occupied_threshold = yaml.number("occupied_thresh", 0.0, 1.0);
  info.free_threshold = yaml.number("free_thresh", 0.0, 1.0);
  if (info.free_threshold >= info.occupied_threshold) {
    yaml.refuse("free_thresh", fmt::format("{}", info.free_threshold),
                fmt::format("less than occupied_thresh ({})", info.occupied_threshold));
  }
  return info;
}

std::int8_t raw_value(std::uint8_t gray) {
  return gray <= OccupancyMap::occupied ? static_cast<std::int8_t>(gray) : OccupancyMap::unknown;
}

/// Nav2's rules: darker means more occupied (lighter, when negated); `p` is the occupancy, 1 for black.
std::int8_t value_of(std::uint8_t gray, const MapFileInfo& info) {
  if (info.mode == MapMode::raw) return raw_value(gray);
  const double p = (info.negate ? gray : 255 - gray) / 255.0;
  if (p >= info.occupied_threshold) return OccupancyMap::occupied;
  if (p <= info.free_threshold) return OccupancyMap::free;
  if (info.mode == MapMode::trinary) return OccupancyMap::unknown;
  const double share = (p - info.free_threshold) / (info.occupied_threshold - info.free_threshold);
  return static_cast<std::int8_t>(std::lround(share * OccupancyMap::occupied));
}

/// In raw mode the pixel is the occupancy value itself, and alpha is ignored.
bool is_transparent(const MapImage& image, std::size_t pixel, MapMode mode) {
  return mode != MapMode::raw && !image.transparent.empty() && image.transparent[pixel];
}

/// The image's top row is the grid's last.
void fill_cells(const MapImage& image, const MapFileInfo& info, OccupancyMap& map) {
  map.columns = image.width_px;
  map.rows = image.height_px;
  map.cells.resize(image.gray.size());
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const std::size_t pixel = map.index({column, map.rows - 1 - row});
      map.cells[map.index({column, row})] =
          is_transparent(image, pixel, info.mode) ? OccupancyMap::unknown : value_of(image.gray[pixel], info);
    }
  }
}

void warn_of_unknown_read_as_free(const MapImage& image, LoadedMap& loaded, const fs::path& file) {
  const bool saver_unknown_is_free = loaded.info.mode == MapMode::trinary && !loaded.info.negate &&
                                     value_of(saved_unknown, loaded.info) == OccupancyMap::free;
  if (!saver_unknown_is_free || std::ranges::find(image.gray, saved_unknown) == image.gray.end()) return;
  loaded.warnings.push_back(
      fmt::format("{}: free_thresh {} reads pixels of 205, which map savers write for unknown, as free; "
                  "0.196 keeps them unknown",
                  file.string(), loaded.info.free_threshold));
}

bool is_trinary(const OccupancyMap& map) {
  return std::ranges::all_of(map.cells, [](std::int8_t value) {
    return value == OccupancyMap::free || value == OccupancyMap::occupied || value == OccupancyMap::unknown;
  });
}

std::uint8_t trinary_gray(std::int8_t value) {
  if (value == OccupancyMap::unknown) return saved_unknown;
  return value == OccupancyMap::free ? saved_free : saved_occupied;
}

MapImage image_of(const OccupancyMap& map, bool trinary) {
  MapImage image{.width_px = map.columns, .height_px = map.rows, .gray = {}, .transparent = {}};
  image.gray.reserve(map.cells.size());
  for (int row = map.rows - 1; row >= 0; --row) {
    for (int column = 0; column < map.columns; ++column) {
      const std::int8_t value = map.at({column, row});
      const std::uint8_t raw = value < 0 ? raw_unknown : static_cast<std::uint8_t>(value);
      image.gray.push_back(trinary ? trinary_gray(value) : raw);
    }
  }
  return image;
}

/// The image's name in a map's YAML file as it is now; empty when there is none that can be read.
std::string present_image(const fs::path& yaml_file) {
  try {
    return StrictYaml::load(yaml_file).text("image");
  } catch (const InputError&) {
    return "";
  }
}

/// Images that the folder's other YAML files name: `map.yml` beside a `map.yaml` must not take its image.
std::set<std::string> images_of_others(const fs::path& yaml_file) {
  const fs::path folder = yaml_file.has_parent_path() ? yaml_file.parent_path() : fs::path(".");
  std::set<std::string> images;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".yaml" && extension != ".yml") continue;
    if (entry.path().filename() != yaml_file.filename()) images.insert(present_image(entry.path()));
  }
  return images;
}

/// Not that of the image which the file names at present: until the YAML file is replaced, the old map is
/// valid.
std::string free_image_name(const fs::path& yaml_file, const std::string& before,
                            const std::set<std::string>& of_others) {
  const std::string stem = yaml_file.stem().string();
  std::string name = stem + ".pgm";
  for (std::string suffix = "_b"; name == before || of_others.contains(name); suffix += "_b")
    name = stem + suffix + ".pgm";
  return name;
}

}  // namespace

LoadedMap load_map(const fs::path& yaml_file) {
  StrictYaml yaml = StrictYaml::load(yaml_file);
  LoadedMap loaded;
  loaded.info = read_info(yaml);
  constexpr double finest_m = 1e-4;
  constexpr double coarsest_m = 100.0;
  loaded.map.resolution_m = yaml.number("resolution", finest_m, coarsest_m);
  const std::vector<double> origin = yaml.numbers("origin", 3);
  loaded.map.map_from_grid = {{origin[0], origin[1]}, origin[2]};
  for (const StrictYaml::OtherKey& key : yaml.take_other_keys()) {
    loaded.info.other_keys += key.yaml + "\n";
    loaded.warnings.push_back(fmt::format("{}:{}: the key '{}' is not known here and has no effect",
                                          yaml_file.string(), key.line, key.name));
  }

  try {
    const MapImage image = read_map_image(loaded.info.image);
    fill_cells(image, loaded.info, loaded.map);
    warn_of_unknown_read_as_free(image, loaded, yaml_file);
  } catch (const std::runtime_error& error) {
    yaml.refuse("image", fmt::format("'{}' ({})", loaded.info.image.string(), error.what()),
                "a PGM, PNG or BMP file");
  }
  return loaded;
}

void check_map_name(const fs::path& yaml_file) {
  const std::string extension = yaml_file.extension().string();
  if (extension != ".yaml" && extension != ".yml") {
    throw InputError(fmt::format("{}: found '{}', wanted the name of a YAML file: .yaml or .yml",
                                 yaml_file.string(), extension));
  }
}

void save_map(const OccupancyMap& map, const fs::path& yaml_file, const std::string& other_keys) {
  check_map_name(yaml_file);
  const std::string before = present_image(yaml_file);
  const std::set<std::string> of_others = images_of_others(yaml_file);
  const std::string name = free_image_name(yaml_file, before, of_others);
  const fs::path image_file = yaml_file.parent_path() / name;
  const bool trinary = is_trinary(map);
  const Pose2& origin = map.map_from_grid;
  write_file_atomically(image_file, pgm_text(image_of(map, trinary)));
  write_file_atomically(
      yaml_file, fmt::format("image: {}\nmode: {}\nresolution: {}\norigin: [{}, {}, {}]\nnegate: 0\n"
                             "occupied_thresh: {}\nfree_thresh: {}\n{}",
                             name, trinary ? "trinary" : "raw", map.resolution_m, origin.position_m.x(),
                             origin.position_m.y(), origin.yaw_rad, saved_occupied_threshold,
                             saved_free_threshold, other_keys));
  const std::string stem = yaml_file.stem().string();
  const bool was_ours = (before == stem + ".pgm" || before == stem + "_b.pgm") && !of_others.contains(before);
  std::error_code none;
  if (was_ours) fs::remove(yaml_file.parent_path() / before, none);
}

}  // namespace lodestar
