#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/console/lease.hpp"
#include "app/live/live_channel.hpp"
#include "app/live/live_link.hpp"
#include "app/site/site.hpp"

namespace lodestar {

template <typename View>
class ViewSession;

/// rosbridge 2.0 for clients that offer no subprotocol, such as roslib: topics /map, /amcl_pose and /plan to
/// subscribe to, /goal_pose and /initialpose to publish, the service /rosapi/topics, and the action
/// /navigate_to_pose (nav2_msgs/NavigateToPose) with feedback, result and cancel.
///
/// Who drives needs the token to drive, and has the console's control lease while the goal is under way: no
/// other client drives meanwhile, and the robot pauses when the connection ends.
class RosbridgeView : public LiveChannel {
 public:
  /// All must outlive this.
  RosbridgeView(const Site& site, LiveLink& link, Lease& lease);

  [[nodiscard]] std::vector<SocketProtocol> protocols() override;
  [[nodiscard]] bool is_watched() const override { return !clients_.empty(); }
  void pump(Stamp now, const RobotState* fresh) override;
  void take_markers(const MarkerRegistry& /*saved*/) override {}

 private:
  friend class ViewSession<RosbridgeView>;
  /// A drive that a client asked for.
  struct Drive {
    std::uint64_t ticket = 0;
    Vec2 goal_m = Vec2::Zero();
    std::string id;  ///< of the action's goal; empty for one by topic, of which nobody hears
    bool wants_feedback = false;
    bool is_cancelled = false;
    std::optional<Stamp> since;  ///< by the robot's time
  };
  struct Client {
    int number = 0;  ///< below 0, among those who have the lease
    Role role = Role::view;
    Outbox* outbox = nullptr;
    std::map<std::string, int> topics;  ///< subscribed to, with the slot of each in the outbox
    std::optional<Drive> drive;
  };

  void add_client(Client& client);
  void remove_client(const Client& client);
  void receive(Client& client, const nlohmann::json& message, Stamp now);
  [[nodiscard]] const SocketMessage& map_message();
  void subscribe(Client& client, const std::string& topic);
  void publish(Client& client, const nlohmann::json& message, Stamp now);
  void call_service(Client& client, const nlohmann::json& message);
  void send_goal(Client& client, const nlohmann::json& message, Stamp now);
  void cancel(Client& client);
  void drive_to(Client& client, const Goal& goal, const Drive& drive, Stamp now);
  void follow_drive(Client& client, const RobotState& state, Stamp now);
  void end_drive(Client& client, int status, const std::string& why);
  void offer(const std::string& topic, const nlohmann::ordered_json& content);
  static void refuse_goal(const Client& client, const std::string& id, const std::string& why);

  const Site& site_;
  LiveLink& link_;
  Lease& lease_;
  std::vector<Client*> clients_;
  int clients_so_far_ = 0;
  std::uint64_t tickets_so_far_ = 0;
  std::shared_ptr<const Path> path_;
  SocketMessage map_;
  Stamp last_pose_;
};

}  // namespace lodestar
