#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "maps/geometry.hpp"

// The messages of VDA 5050, versions 2.0.0 and 2.1.0, as values: what a fleet's master sends, and the words
// that both sides use.
namespace lodestar {

enum class VdaVersion { v2_0_0, v2_1_0 };
std::string_view to_string(VdaVersion version);
/// Nothing for an unknown version.
std::optional<VdaVersion> vda_version(std::string_view text);

/// May the robot drive, or do other things, while it does this?
enum class Blocking { none, soft, hard };
enum class ActionStatus { waiting, running, finished, failed };
/// A warning resolves itself, or by the master; a fatal error needs a person at the robot.
enum class ErrorLevel { warning, fatal };
enum class OperatingMode { automatic, manual };
enum class EmergencyStop { none, manual };
enum class ConnectionState { online, offline, broken };
// The words of the standard.
std::string_view to_string(Blocking blocking);
std::string_view to_string(ActionStatus status);
std::string_view to_string(ErrorLevel level);
std::string_view to_string(OperatingMode mode);
std::string_view to_string(EmergencyStop stop);
std::string_view to_string(ConnectionState state);

/// Types of errors. The rejections stay until an order is accepted.
namespace vda_error {
inline constexpr const char* validation = "validationError";
inline constexpr const char* order = "orderError";
inline constexpr const char* order_update = "orderUpdateError";
inline constexpr const char* no_route = "noRouteError";
inline constexpr const char* instant_action = "instantActionError";
inline constexpr const char* no_order_to_cancel = "noOrderToCancel";
inline constexpr const char* order_action = "orderActionError";
inline constexpr const char* drive = "driveError";  ///< our own: the released base was not driven to its end
inline constexpr const char* stopped = "robotStopped";  ///< our own: a reason not to move, at present
}  // namespace vda_error

struct ErrorReference {
  std::string key;
  std::string value;

  bool operator==(const ErrorReference&) const = default;
};

struct FleetError {
  std::string type;
  ErrorLevel level = ErrorLevel::warning;
  std::string description;
  std::vector<ErrorReference> references;
};

struct FleetAction {
  std::string id;
  std::string type;
  Blocking blocking = Blocking::hard;
  std::map<std::string, std::string> parameters;  ///< text as it is, anything else as JSON
};

/// A parameter as a number, also where a master sends it as text; nothing when there is none.
std::optional<double> number_in(const FleetAction& action, const std::string& key);

struct NodePosition {
  Vec2 position_m = Vec2::Zero();
  std::optional<double> heading_rad;
  double deviation_m = 0.0;  ///< allowed; 0: the robot's own tolerance
  double deviation_rad = 0.0;
  std::string map;  ///< its ID; may be empty
};

struct FleetNode {
  std::string id;
  std::uint32_t sequence = 0;
  bool released = false;
  std::optional<NodePosition> at;  ///< nothing: the robot is to know the node by its name
  std::vector<FleetAction> actions;
};

struct FleetEdge {
  std::string id;
  std::uint32_t sequence = 0;
  bool released = false;
  std::string from;
  std::string to;
  std::optional<double> max_mps;
  std::vector<FleetAction> actions;
  std::vector<std::string> demands;  ///< names of optional fields that this robot does not obey
};

struct FleetOrder {
  std::uint32_t header = 0;
  std::string id;
  std::uint32_t update = 0;
  std::string zone_set;
  std::vector<FleetNode> nodes;  ///< by sequence: 0, 2, 4 ... or from the stitching node on
  std::vector<FleetEdge> edges;  ///< one between two nodes
};

struct InstantActions {
  std::uint32_t header = 0;
  std::vector<FleetAction> actions;
};

/// What came from the master: an order, actions, or why it cannot be read.
using FleetMessage = std::variant<FleetOrder, InstantActions, FleetError>;

}  // namespace lodestar
