#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace lodestar {

/// A robot file's text with these keys of `camera_mount` (x_m, yaw_deg, ...) replaced, and everything else,
/// comments included, unchanged. Throws InputError when the file has no such keys.
std::string with_camera_mount(const std::filesystem::path& robot_file,
                              const std::map<std::string, std::string>& values);

}  // namespace lodestar
