#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <utility>

#include "app/navigation/mission.hpp"
#include "app/placement/live_map.hpp"
#include "app/site/site.hpp"

namespace lodestar {

CLI::Option* add_map_option(CLI::App& command, std::string& file);

/// The map that `--build-map` asks for; null where it does not. Throws InputError for a robot without a
/// scanner. `made_by` is for the map's file.
std::unique_ptr<LiveMap> live_map(const std::string& file, const Site& site, const std::string& made_by,
                                  bool can_wait);

/// Makes it listen to a run or a replay; what took part before goes on.
template <typename Options>
void attend_map(Options& options, LiveMap& map) {
  options.attend = [&map, others = std::move(options.attend)](const SensorInput& heard,
                                                              const MissionStep& step, Mission& mission) {
    map.take(heard.scans, step.navigation.estimate);
    if (others) others(heard, step, mission);
  };
}

/// One line, of what became of it; true when the map is whole. True without a map, too.
bool print_map(LiveMap* map);

}  // namespace lodestar
