#include "app/commands/fleet_service.hpp"

#include <algorithm>
#include <cctype>
#include <unistd.h>

#include "app/common/log.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// A site's name as a topic may have it.
std::string topic_word(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) >= 0x80 ||
        (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-'))
      c = '_';
  return name;
}

std::string named(const std::string& name, const std::string& words) {
  return name.empty() ? words : name + ": " + words;
}

}  // namespace

CLI::Option* add_fleet_option(CLI::App& command, FleetArguments& arguments) {
  return command
      .add_option_function<std::string>(
          "--fleet",
          [&arguments](const std::string& broker) {
            arguments.is_wanted = true;
            arguments.broker = broker;
          },
          "Drive by the orders of a VDA 5050 fleet manager until Ctrl-C; with the MQTT broker's address, "
          "mqtts://HOST[:PORT], where it is not the site's")
      ->expected(0, 1)
      ->type_name("[URL]");
}

FleetSettings fleet_settings(const Site& site, const FleetArguments& arguments, bool is_simulated) {
  const std::optional<FleetSettings> kept = load_fleet_settings(site.folder);
  if (!kept && !is_simulated)
    throw InputError(site.folder / "site.yaml", 0, "no fleet",
                     "fleet: {broker, interface, manufacturer, serial, version}");
  FleetSettings settings = kept.value_or(FleetSettings{});
  if (!kept) {
    settings.manufacturer = "lodestar";
    settings.serial = topic_word(site.name);
  }
  if (!arguments.broker.empty()) settings.broker = arguments.broker;
  if (settings.broker.empty()) throw InputError("--fleet: found no broker, wanted mqtts://HOST[:PORT]");
  (void)broker_address(settings.broker);
  for (const ActionHook& action : settings.actions)
    if (access(action.command.front().c_str(), X_OK) != 0)
      throw InputError(site.folder / "site.yaml", 0, "'" + action.command.front() + "'",
                       "a program that can be run for action " + action.type);
  return settings;
}

FleetService::FleetService(const Site& site, const FleetSettings& settings, const std::string& name)
    : session_(link_, fleet_session_options(site, settings),
               [name](const std::string& words) { log_info(named(name, words)); }),
      transport_(settings, factsheet_of(site.robot, settings, site.charging.has_value()), link_,
                 [name](Severity severity, const std::string& words) {
                   program_log().say(severity, named(name, words));
                 }) {}

}  // namespace lodestar
