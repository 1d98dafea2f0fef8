#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "maps/stamp.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {

/// A type of action that a program of the site carries out, for a mission or a fleet manager: an item of
/// `actions`.
struct ActionHook {
  std::string type;
  std::vector<std::string>
      command;  ///< the program, an absolute path or one below the site, and its arguments
  Duration timeout{};
};

/// How a fleet manager reaches the robot by VDA 5050: `fleet` of site.yaml.
struct FleetSettings {
  std::string broker;              ///< "mqtts://host[:port]"; "mqtt:" only to this machine
  std::string interface = "uagv";  ///< the first part of all topics
  std::string manufacturer;
  std::string serial;
  std::string version = "2.0.0";  ///< or "2.1.0": of the messages, as the master wants it
  std::string map;                ///< the map's ID in messages; empty: the site's name
  std::string user;               ///< at the broker; empty: none
  std::filesystem::path password_file;
  std::filesystem::path ca_file;  ///< that the broker's certificate is checked by; empty: the system's
  std::filesystem::path certificate_file;  ///< of this client, with its key
  std::filesystem::path key_file;
  std::vector<ActionHook> actions;
};

/// The list `actions` of site.yaml, or of its `fleet`.
std::vector<ActionHook> read_action_hooks(std::vector<StrictYaml> list, const std::filesystem::path& folder);

/// Of a site folder, with the actions of the site itself; nothing where its site.yaml has no `fleet`.
/// load_site() has checked it before.
std::optional<FleetSettings> load_fleet_settings(const std::filesystem::path& folder);

/// Where the broker listens.
struct BrokerAddress {
  bool has_tls = true;
  std::string host;
  int port = 8883;
};

/// Of "mqtts://host[:port]". Throws InputError for anything else, and for "mqtt:" to another machine.
BrokerAddress broker_address(const std::string& url);

/// Paths are relative to the site's folder.
FleetSettings read_fleet_settings(StrictYaml yaml, const std::filesystem::path& folder);

/// Percent of charge by the battery's voltage at rest: rising volts, at least two.
struct BatteryCurve {
  std::vector<double> volts;
  std::vector<double> percent;

  /// Linear between the points, and as at the ends beyond them.
  [[nodiscard]] double percent_at(double battery_v) const;
};

BatteryCurve read_battery_curve(StrictYaml yaml);

/// Of a robot.yaml; nothing where it has no `battery`.
std::optional<BatteryCurve> load_battery_curve(const std::filesystem::path& robot_file);

}  // namespace lodestar
