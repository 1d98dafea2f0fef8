#pragma once

#include <deque>
#include <set>
#include <string>

#include "app/fleet/fleet_messages.hpp"

namespace lodestar {

struct OrderBookOptions {
  std::string map;                                ///< the ID of the robot's map
  std::map<std::string, NodePosition> positions;  ///< of nodes that an order only names
  std::set<std::string> node_actions;             ///< types that are offered at nodes
  std::set<std::string> instant_actions;          ///< besides startPause, stopPause and cancelOrder
  /// How far from its first node a robot may begin an order where the master allows no more; it then drives
  /// onto the node. Chosen by hand: a third of the usual distance between nodes.
  double start_tolerance_m = 0.3;
  double heading_tolerance_rad = radians(5.0);  ///< at the first node, before it turns there
  double slowest_mps = 0.0;                     ///< the robot's; a limit of an edge below it cannot be kept
};

/// An action and what has come of it.
struct ActionRecord {
  FleetAction action;
  ActionStatus status = ActionStatus::waiting;
  std::string result;
  std::uint32_t sequence = 0;  ///< of its node; of an instant action 0
  bool is_instant = false;
  bool is_due = false;  ///< its node has been reached
};

inline bool has_ended(const ActionRecord& record) {
  return record.status == ActionStatus::finished || record.status == ActionStatus::failed;
}

/// A node to drive to.
struct DriveTarget {
  std::string node;
  std::uint32_t sequence = 0;
  Vec2 position_m = Vec2::Zero();
  std::optional<double> heading_rad;
  std::optional<double> max_mps = std::nullopt;  ///< on the edge that leads there
  bool rests = false;  ///< an action there, or the end of the base, asks the robot to stop
};

/// The orders of a VDA 5050 master, as a robot keeps them: which are accepted (6.6.2, figure 8), what of the
/// present one is left, which actions are due, and what went wrong. Knows neither time, nor robot, nor
/// network.
///
///      lastNode                    last released
///         o----------o----------o ............ o ............ o
///         traversed      base                horizon
///
/// The base never changes; an update begins with its last node, and replaces the horizon.
class OrderBook {
 public:
  explicit OrderBook(OrderBookOptions options);

  // -- what the master sends

  void take(const FleetMessage& message, const std::optional<Pose2>& map_from_base);

  // -- what has happened

  /// The robot has come to this node: it and what lies before it are traversed, and its actions are due.
  void reached(std::uint32_t sequence);
  /// The drive over the base ended early. The order stays until the master cancels it.
  void drive_failed(const std::string& why);
  /// The robot stands, and no drive is under way: a pause or a cancellation is then complete.
  void came_to_rest();
  void action_ended(const std::string& id, bool succeeded, const std::string& result = {});
  /// A person drives: the order is cleared, and none is accepted until the robot is on its own again.
  void set_mode(OperatingMode mode);
  /// A person let the robot go on.
  void resume();
  /// After initPosition.
  void set_last_node(const std::string& id);
  /// A reason not to move at present; empty for none.
  void set_stopped(const std::string& why);

  // -- what is to be done

  /// The released nodes ahead, in turn, up to the first where the robot rests. Empty while it must not drive.
  [[nodiscard]] std::vector<DriveTarget> targets() const;
  /// Actions that begin now; they are running from then on.
  [[nodiscard]] std::vector<FleetAction> start_actions();
  [[nodiscard]] bool is_paused() const { return is_paused_; }
  [[nodiscard]] bool is_cancelling() const { return is_cancelling_; }
  /// Is an order under way, or does one wait for its base to be extended?
  [[nodiscard]] bool is_active() const;
  [[nodiscard]] bool is_running(const std::string& action_id) const;

  // -- what the state says

  /// Increased with each change of what the state says.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] const std::string& order_id() const { return order_id_; }
  [[nodiscard]] std::uint32_t update_id() const { return update_id_; }
  [[nodiscard]] const std::string& last_node_id() const { return last_node_id_; }
  [[nodiscard]] std::uint32_t last_sequence() const { return last_sequence_; }
  /// Not yet traversed.
  [[nodiscard]] const std::deque<FleetNode>& nodes() const { return nodes_; }
  [[nodiscard]] const std::deque<FleetEdge>& edges() const { return edges_; }
  /// Those of the order first, then instant actions.
  [[nodiscard]] std::vector<ActionRecord> actions() const;
  [[nodiscard]] std::vector<FleetError> errors() const;
  [[nodiscard]] OperatingMode mode() const { return mode_; }

 private:
  void take_order(const FleetOrder& order, const std::optional<Pose2>& map_from_base);
  void begin(const FleetOrder& order, const std::optional<Pose2>& map_from_base);
  void update(const FleetOrder& order);
  void take_instant(const FleetAction& action);
  void cancel(ActionRecord& record);
  void clear_order(const std::string& why);
  void reject(FleetError error);
  void drop_rejections();
  void append(const FleetOrder& order, std::size_t from);
  void add_actions(const FleetNode& node, bool is_due);
  void changed() { ++revision_; }
  [[nodiscard]] bool is_known(const std::string& action_id) const;
  [[nodiscard]] std::optional<FleetError> infeasible(const FleetOrder& order) const;
  [[nodiscard]] const NodePosition* position_of(const FleetNode& node) const;
  [[nodiscard]] bool must_stay() const;
  [[nodiscard]] bool rests_at(const FleetNode& node) const;
  [[nodiscard]] std::optional<double> limit_before(const FleetNode& node) const;

  OrderBookOptions options_;
  std::string order_id_;
  std::uint32_t update_id_ = 0;
  std::string last_node_id_;
  std::uint32_t last_sequence_ = 0;
  std::deque<FleetNode> nodes_;
  std::deque<FleetEdge> edges_;
  std::deque<ActionRecord> order_actions_;
  std::deque<ActionRecord> instant_actions_;
  std::deque<std::string> old_action_ids_;  ///< instant ones that the state no longer lists
  std::deque<FleetError> rejections_;
  std::optional<FleetError> drive_error_;
  std::string stopped_;
  OperatingMode mode_ = OperatingMode::automatic;
  bool is_paused_ = false;
  bool is_cancelling_ = false;
  bool was_cleared_ = false;  ///< the present order ID is of an order that was cancelled
  std::uint64_t revision_ = 1;
};

}  // namespace lodestar
