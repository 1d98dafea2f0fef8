#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "maps/camera_model.hpp"

namespace lodestar {

/// A camera file with what other programs keep in it.
struct CameraFile {
  CameraModel camera;
  std::string other_keys;             ///< lines of YAML: keys that this program does not know
  std::vector<std::string> warnings;  ///< one for each of these keys, with file and line
};

/// The same as load_camera(), with the keys that it passes over. Throws InputError.
CameraFile read_camera_file(const std::filesystem::path& file);

/// The same as save_camera() without them; `other_keys` are lines of YAML to be kept.
void save_camera(const CameraModel& camera, const std::string& name, const std::filesystem::path& file,
                 const std::string& other_keys);

}  // namespace lodestar
