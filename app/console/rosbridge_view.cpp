#include "app/console/rosbridge_view.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

#include "app/console/live_json.hpp"
#include "app/console/rosbridge_json.hpp"
#include "app/console/view_session.hpp"
#include "maps/input_error.hpp"
#include "planning/route.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* action = "/navigate_to_pose";
constexpr Duration pose_period = std::chrono::milliseconds(100);

// action_msgs/GoalStatus.
constexpr int status_succeeded = 4;
constexpr int status_cancelled = 5;
constexpr int status_aborted = 6;

const std::map<std::string, std::string>& types_by_topic() {
  static const std::map<std::string, std::string> types{
      {"/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped"},
      {"/goal_pose", "geometry_msgs/msg/PoseStamped"},
      {"/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped"},
      {"/map", "nav_msgs/msg/OccupancyGrid"},
      {"/plan", "nav_msgs/msg/Path"}};
  return types;
}

SocketMessage published(const std::string& topic, const ordered_json& content) {
  return message_of({{"op", "publish"}, {"topic", topic}, {"msg", content}});
}

/// Topics and actions with and without the leading slash are the same.
std::string full_name(const std::string& name) {
  return name.starts_with('/') ? name : "/" + name;
}

std::string id_of(const json& message) {
  return message.contains("id") && message.at("id").is_string() ? message.at("id").get<std::string>() : "";
}

void tell(Outbox& outbox, const std::string& id, const std::string& words) {
  outbox.queue(message_of({{"op", "status"}, {"id", id}, {"level", "error"}, {"msg", words}}));
}

/// When something of `stamp` was, of which `now` is now, since 1970.
Duration unix_time(Stamp stamp, Stamp now) {
  const auto wall = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<Duration>(wall) - (now - stamp);
}

}  // namespace

RosbridgeView::RosbridgeView(const Site& site, LiveLink& link, Lease& lease)
    : site_(site), link_(link), lease_(lease) {}

std::vector<SocketProtocol> RosbridgeView::protocols() {
  return {{.name = "", .open = [this](Role role, Outbox& outbox) -> std::unique_ptr<SocketSession> {
             return std::make_unique<ViewSession<RosbridgeView>>(*this, role, outbox);
           }}};
}

void RosbridgeView::add_client(Client& client) {
  client.number = --clients_so_far_;
  clients_.push_back(&client);
}

void RosbridgeView::remove_client(const Client& client) {
  std::erase(clients_, &client);
  lease_.release(client.number);
  link_.hold_until(lease_.until());
}

void RosbridgeView::receive(Client& client, const json& message, Stamp now) {
  const auto op = message.at("op").get<std::string>();
  const std::string id = id_of(message);
  try {
    if (op == "subscribe") {
      subscribe(client, full_name(message.at("topic").get<std::string>()));
    } else if (op == "unsubscribe") {
      client.topics.erase(full_name(message.at("topic").get<std::string>()));
    } else if (op == "publish") {
      publish(client, message, now);
    } else if (op == "call_service") {
      call_service(client, message);
    } else if (op == "send_action_goal") {
      send_goal(client, message, now);
    } else if (op == "cancel_action_goal") {
      if (client.drive && client.drive->id == id) cancel(client);
    } else if (op != "advertise" && op != "unadvertise" && op != "set_level" && op != "status") {
      tell(*client.outbox, id, "found op '" + op.substr(0, 40) + "', which is not served here");
    }
  } catch (const InputError& error) {
    tell(*client.outbox, id, error.what());
  }
  link_.hold_until(lease_.until());
}

/// Made once: whoever asks for it again and again must not delay a stop.
const SocketMessage& RosbridgeView::map_message() {
  constexpr std::size_t most_cells = 1'000'000;  // some 3 MB as JSON, made in some 50 ms
  if (site_.map.map.cells.size() > most_cells)
    throw InputError("found a map of more than a million cells: too large for JSON, wanted --ros2");
  if (!map_.bytes) map_ = published("/map", grid_json(unix_time({}, {}), site_.map.map));
  return map_;
}

/// What stands is sent at once.
void RosbridgeView::subscribe(Client& client, const std::string& topic) {
  if (!types_by_topic().contains(topic))
    throw InputError("found topic '" + topic.substr(0, 80) + "', wanted one of /rosapi/topics");
  const auto slot = static_cast<int>(std::distance(types_by_topic().begin(), types_by_topic().find(topic)));
  client.topics[topic] = slot;
  if (topic == "/map") {
    client.outbox->offer(slot, map_message());
  } else if (topic == "/plan") {
    client.outbox->offer(slot, published(topic, plan_json(unix_time({}, {}), path_ ? *path_ : Path{})));
  }
}

void RosbridgeView::publish(Client& client, const json& message, Stamp now) {
  const std::string topic = full_name(message.at("topic").get<std::string>());
  if (client.role < Role::drive) throw InputError("this needs the token to drive");
  if (topic == "/goal_pose") {
    drive_to(client, goal_from_pose_stamped(message.at("msg")), {}, now);
  } else if (topic == "/initialpose") {
    if (lease_.holder(now).value_or(client.number) != client.number)
      throw InputError("another client has control");
    if (!link_.give({.by = "ROS", .what = PlaceOrder{pose_from_initial(message.at("msg"))}}))
      throw InputError("too many orders are still waiting for the robot");
  } else {
    throw InputError("found topic '" + topic.substr(0, 80) + "', wanted /goal_pose or /initialpose");
  }
}

void RosbridgeView::call_service(Client& client, const json& message) {
  const std::string service = full_name(message.at("service").get<std::string>());
  ordered_json answer{{"op", "service_response"}, {"id", id_of(message)}, {"service", service}};
  if (service == "/rosapi/topics") {
    ordered_json topics = ordered_json::array();
    ordered_json types = ordered_json::array();
    for (const auto& [topic, type] : types_by_topic()) {
      topics.push_back(topic);
      types.push_back(type);
    }
    answer["values"] = {{"topics", topics}, {"types", types}};
    answer["result"] = true;
  } else if (service == std::string(action) + "/_action/cancel_goal") {
    if (client.drive) cancel(client);
    answer["values"] = ordered_json::object();
    answer["result"] = true;
  } else {
    answer["values"] = "found service '" + service.substr(0, 80) + "', wanted /rosapi/topics";
    answer["result"] = false;
  }
  client.outbox->queue(message_of(answer));
}

void RosbridgeView::refuse_goal(const Client& client, const std::string& id, const std::string& why) {
  client.outbox->queue(message_of({{"op", "action_result"},
                                   {"id", id},
                                   {"action", action},
                                   {"values", why},
                                   {"status", status_aborted},
                                   {"result", false}}));
}

void RosbridgeView::send_goal(Client& client, const json& message, Stamp now) {
  const std::string id = id_of(message);
  try {
    if (full_name(message.at("action").get<std::string>()) != action)
      throw InputError(std::string("found another action, wanted ") + action);
    if (client.role < Role::drive) throw InputError("this needs the token to drive");
    const json& arguments = message.at("args");
    drive_to(client, goal_from_pose_stamped(arguments.at("pose")),
             {.id = id, .wants_feedback = message.value("feedback", false)}, now);
  } catch (const InputError& error) {
    refuse_goal(client, id, error.what());
  } catch (const json::exception&) {
    refuse_goal(client, id, "found another goal, wanted {pose: geometry_msgs/PoseStamped}");
  }
}

void RosbridgeView::drive_to(Client& client, const Goal& goal, const Drive& drive, Stamp now) {
  if (!lease_.take(client.number, now)) throw InputError("another client has control");
  const std::uint64_t ticket = ++tickets_so_far_;
  if (!link_.give({.by = "ROS", .what = GoOrder{{goal}, ticket}}))
    throw InputError("too many orders are still waiting for the robot");
  if (client.drive) end_drive(client, status_aborted, "a new goal took its place");
  client.drive = drive;
  client.drive->ticket = ticket;
  client.drive->goal_m = goal.position_m;
}

void RosbridgeView::cancel(Client& client) {
  client.drive->is_cancelled = true;
  link_.stop("a program of ROS");
}

void RosbridgeView::end_drive(Client& client, int status, const std::string& why) {
  const std::string id = client.drive->id;
  client.drive.reset();
  if (id.empty()) return;
  // Fields of the result since Jazzy; Humble's has none.
  client.outbox->queue(message_of({{"op", "action_result"},
                                   {"id", id},
                                   {"action", action},
                                   {"values", {{"error_code", why.empty() ? 0 : 1}, {"error_msg", why}}},
                                   {"status", status},
                                   {"result", true}}));
}

void RosbridgeView::pump(Stamp now, const RobotState* fresh) {
  for (Client* const client : clients_)  // alive as long as its connection is
    if (client->drive) (void)lease_.hold(client->number, now);
  link_.hold_until(lease_.until());
  if (fresh == nullptr) return;
  const Duration time = unix_time({}, {});
  if (fresh->path != path_) offer("/plan", plan_json(time, fresh->path ? *fresh->path : Path{}));
  path_ = fresh->path;
  if (fresh->estimate && now - last_pose_ >= pose_period) {
    last_pose_ = now;
    offer("/amcl_pose", estimate_json(unix_time(fresh->estimate->stamp, fresh->now), *fresh->estimate));
  }
  for (Client* const client : clients_)
    if (client->drive) follow_drive(*client, *fresh, now);
}

void RosbridgeView::follow_drive(Client& client, const RobotState& state, Stamp now) {
  Drive& drive = *client.drive;
  const auto ended = std::ranges::find(state.ended, drive.ticket, &EndedDrive::ticket);
  if (ended != state.ended.end()) {
    const int status = ended->arrived       ? status_succeeded
                       : drive.is_cancelled ? status_cancelled
                                            : status_aborted;
    end_drive(client, status, ended->why);
    lease_.release(client.number);
    link_.hold_until(lease_.until());
    return;
  }
  if (lease_.holder(now) != client.number)
    return end_drive(client, status_aborted, "another client took control");
  if (!drive.wants_feedback || !state.estimate) return;
  if (!drive.since) drive.since = state.now;
  const Vec2& here_m = state.estimate->map_from_base.position_m;
  const bool is_planned = state.path && !state.path->waypoints_m.empty() &&
                          (state.path->waypoints_m.back() - drive.goal_m).norm() < 1e-6;
  const double left_m = is_planned ? length_m(rest_of(*state.path, here_m)) : (drive.goal_m - here_m).norm();
  constexpr int feedback_slot = 100;  // the newest is enough
  client.outbox->offer(
      feedback_slot,
      message_of({{"op", "action_feedback"},
                  {"id", drive.id},
                  {"action", action},
                  {"values", feedback_json(unix_time(state.estimate->stamp, state.now), *state.estimate,
                                           state.now - *drive.since, left_m)}}));
}

void RosbridgeView::offer(const std::string& topic, const ordered_json& content) {
  std::optional<SocketMessage> message;
  for (const Client* const client : clients_) {
    const auto subscribed = client->topics.find(topic);
    if (subscribed == client->topics.end()) continue;
    if (!message) message = published(topic, content);
    client->outbox->offer(subscribed->second, *message);
  }
}

}  // namespace lodestar
