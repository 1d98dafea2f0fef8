#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <utility>

#include "app/navigation/charging.hpp"
#include "app/site/site.hpp"

namespace lodestar {

CLI::Option* add_charge_option(CLI::App& command, bool& is_wanted);

/// Of a site with a dock; `goes_by_itself`: also when the battery is low.
std::optional<Charging> charging_of(const Site& site, bool goes_by_itself);

/// The same for `--charge`: the way to the dock comes behind `goals`. Throws InputError for a site without a
/// dock.
Charging charging_after(std::vector<Goal>& goals, const Site& site);

/// Makes it take part in a run or a replay; what took part before goes on.
template <typename Options>
void attend_charging(Options& options, Charging& charging) {
  options.attend = [&charging, others = std::move(options.attend)](
                       const SensorInput& heard, const MissionStep& step, Mission& mission) {
    charging.watch(heard.now, heard.base, step, mission);
    if (others) others(heard, step, mission);
  };
}

/// One line, of how it ended; true when the battery is full.
bool print_charge(const Charging& charging);

}  // namespace lodestar
