#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "maps/occupancy_map.hpp"

namespace lodestar {

/// How pixel values become occupancy (ROS map_server `mode`).
enum class MapMode { trinary, scale, raw };

/// The keys of a ROS map_server YAML file.
struct MapFileInfo {
  std::filesystem::path image;
  MapMode mode = MapMode::trinary;
  bool negate = false;
  double occupied_threshold = 0.65;
  double free_threshold = 0.196;
  std::string other_keys;  ///< lines of YAML: keys that this program does not know
};

struct LoadedMap {
  OccupancyMap map;
  MapFileInfo info;
  std::vector<std::string> warnings;  ///< unknown keys; 205 (unknown to the saver) read as free
};

/// Reads a map_server YAML file and its image (PGM P2/P5, PNG, BMP; relative to the YAML file). Throws
/// InputError with file and line: missing keys, NaN or infinite origin, resolution <= 0,
/// thresholds out of order, an image that is missing or broken.
LoadedMap load_map(const std::filesystem::path& yaml_file);

/// Throws InputError for a name without .yaml or .yml, which might be that of the image.
void check_map_name(const std::filesystem::path& yaml_file);

/// Writes `yaml_file` and the image beside it (STEM.pgm, or STEM_b.pgm when the YAML file names STEM.pgm
/// already, or another YAML file beside it does): at every moment, also after a power cut, the YAML file
/// names a complete image, the old or the new one. The mode is lossless: trinary when all values are 0, 100
/// or -1, raw otherwise. Numbers are written such that reading returns the same doubles. Throws InputError
/// as check_map_name() does, and when a file cannot be written.
/// `other_keys` are lines of YAML to be kept, as MapFileInfo has them.
void save_map(const OccupancyMap& map, const std::filesystem::path& yaml_file,
              const std::string& other_keys = {});

}  // namespace lodestar
