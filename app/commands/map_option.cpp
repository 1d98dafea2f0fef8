#include "app/commands/map_option.hpp"

#include <fmt/core.h>

#include "app/common/log.hpp"
#include "maps/input_error.hpp"

namespace lodestar {

CLI::Option* add_map_option(CLI::App& command, std::string& file) {
  return command.add_option("--build-map", file,
                            "map_server YAML file of what the scanner sees, written every ten seconds while "
                            "the robot drives, and at the end");
}

std::unique_ptr<LiveMap> live_map(const std::string& file, const Site& site, const std::string& made_by,
                                  bool can_wait) {
  if (file.empty()) return nullptr;
  if (!site.robot.scanner)
    throw InputError(site.robot_file, 0, "no scanner", "a robot with one, for --build-map");
  return std::make_unique<LiveMap>(
      file, site.robot.scanner->mount,
      LiveMapOptions{.made_by = made_by, .can_wait = can_wait, .tell = log_warning});
}

bool print_map(LiveMap* map) {
  if (map == nullptr) return true;
  const std::string loss = map->finish();
  if (!loss.empty()) {
    fmt::print(stderr, "lodestar: warning: the map is not whole: {}\n", loss);
    return false;
  }
  fmt::print(stderr, "lodestar: map: {}\n", in_words(map->counts()));
  return true;
}

}  // namespace lodestar
