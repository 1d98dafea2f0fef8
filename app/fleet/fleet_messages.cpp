#include "app/fleet/fleet_messages.hpp"

#include <cmath>
#include <sstream>

namespace lodestar {

std::string_view to_string(VdaVersion version) {
  return version == VdaVersion::v2_0_0 ? "2.0.0" : "2.1.0";
}

std::optional<VdaVersion> vda_version(std::string_view text) {
  for (const VdaVersion version : {VdaVersion::v2_0_0, VdaVersion::v2_1_0})
    if (text == to_string(version)) return version;
  return std::nullopt;
}

std::string_view to_string(Blocking blocking) {
  switch (blocking) {
    case Blocking::none:
      return "NONE";
    case Blocking::soft:
      return "SOFT";
    case Blocking::hard:
      return "HARD";
  }
  return "";
}

std::string_view to_string(ActionStatus status) {
  switch (status) {
    case ActionStatus::waiting:
      return "WAITING";
    case ActionStatus::running:
      return "RUNNING";
    case ActionStatus::finished:
      return "FINISHED";
    case ActionStatus::failed:
      return "FAILED";
  }
  return "";
}

std::string_view to_string(ErrorLevel level) {
  return level == ErrorLevel::warning ? "WARNING" : "FATAL";
}

std::string_view to_string(OperatingMode mode) {
  return mode == OperatingMode::automatic ? "AUTOMATIC" : "MANUAL";
}

std::string_view to_string(EmergencyStop stop) {
  return stop == EmergencyStop::none ? "NONE" : "MANUAL";
}

std::string_view to_string(ConnectionState state) {
  switch (state) {
    case ConnectionState::online:
      return "ONLINE";
    case ConnectionState::offline:
      return "OFFLINE";
    case ConnectionState::broken:
      return "CONNECTIONBROKEN";
  }
  return "";
}

std::optional<double> number_in(const FleetAction& action, const std::string& key) {
  const auto found = action.parameters.find(key);
  if (found == action.parameters.end()) return std::nullopt;
  std::istringstream text(found->second);
  text.imbue(std::locale::classic());
  double number = 0.0;
  text >> number;
  if (text.fail() || !(text >> std::ws).eof() || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace lodestar
