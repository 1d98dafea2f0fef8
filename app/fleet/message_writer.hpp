#pragma once

#include <nlohmann/json.hpp>

#include "app/fleet/fleet_report.hpp"
#include "app/site/fleet_settings.hpp"
#include "app/site/site.hpp"

namespace lodestar {

/// What every message begins with.
struct MessageHeader {
  VdaVersion version = VdaVersion::v2_0_0;
  std::uint32_t number = 0;  ///< headerId, counted per topic
  std::string timestamp;     ///< ISO 8601 in UTC, "2026-11-25T03:35:00.123Z"
  std::string manufacturer;
  std::string serial;
};

/// Of wall-clock time, in milliseconds since 1970.
std::string timestamp_text(std::int64_t unix_ms);

// Strict: exactly what the VDA's JSON schemas of that version allow, in valid UTF-8.
std::string state_text(const MessageHeader& header, const FleetReport& report);
std::string connection_text(const MessageHeader& header, ConnectionState state);

/// What the robot can do, for masters: from robot.yaml and the offered actions.
struct Factsheet {
  std::string series;
  double slowest_mps = 0.0;
  double fastest_mps = 0.0;
  double acceleration_mps2 = 0.0;
  double height_m = 0.0;
  double width_m = 0.0;
  double length_m = 0.0;
  double radius_m = 0.0;
  std::vector<Vec2> outline_m;            ///< of the base frame; empty: the disc of that radius
  bool charges = false;                   ///< the site has a dock
  std::vector<std::string> node_actions;  ///< types of the site's own
};
Factsheet factsheet_of(const Robot& robot, const FleetSettings& settings, bool charges);
std::string factsheet_text(const MessageHeader& header, const Factsheet& facts);

}  // namespace lodestar
