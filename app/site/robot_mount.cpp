#include "app/site/robot_mount.hpp"

#include <yaml-cpp/yaml.h>

#include "maps/file_text.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

std::string with_camera_mount(const std::filesystem::path& robot_file,
                              const std::map<std::string, std::string>& values) {
  std::string text = file_text(robot_file, "a robot's YAML file");
  const YAML::Node mount = YAML::Load(text)["camera_mount"];
  std::map<std::size_t, std::pair<std::string, std::string>>
      pieces;  // by position in the text: old value, new value
  for (const auto& [key, value] : values) {
    const YAML::Node node = mount[key];
    const auto line = node ? node.Mark().line + 1 : 0;
    const auto at = node ? static_cast<std::size_t>(node.Mark().pos) : text.size();
    if (!node || text.compare(at, node.Scalar().size(), node.Scalar()) != 0) {
      throw InputError(robot_file, line, "no plain number for '" + key + "' of camera_mount", "one");
    }
    pieces.emplace(at, std::pair(node.Scalar(), value));
  }
  for (auto piece = pieces.rbegin(); piece != pieces.rend();
       ++piece) {  // from the end, so that earlier positions stay valid
    text.replace(piece->first, piece->second.first.size(), piece->second.second);
  }
  return text;
}

}  // namespace lodestar
