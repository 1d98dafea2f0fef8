#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/console/live_view.hpp"
#include "app/console/rosbridge_view.hpp"
#include "app/viewers/foxglove_hub.hpp"

namespace lodestar {
namespace {

/// One client without a socket. A session that throws has ended, and another client connects.
class Client {
 public:
  Client(SocketProtocol protocol, Role role) : protocol_(std::move(protocol)), role_(role) { connect(); }

  void send(const std::string& bytes) {
    try {
      session_->receive(bytes, false);
    } catch (const std::exception&) {
      connect();
    }
    drain();
  }

  void drain() {
    while (const std::optional<SocketMessage> message = outbox_.take()) {
      if (!message->binary && !nlohmann::json::accept(*message->bytes)) __builtin_trap();
    }
  }

 private:
  void connect() { session_ = protocol_.open(role_, outbox_); }

  SocketProtocol protocol_;
  Role role_;
  Outbox outbox_;  // outlives the session
  std::unique_ptr<SocketSession> session_;
};

bool is_sound(const Pose2& pose) {
  return pose.position_m.allFinite() && std::isfinite(pose.yaw_rad);
}

bool is_sound(const Order& order) {
  if (const auto* go = std::get_if<GoOrder>(&order.what)) {
    for (const Goal& goal : go->goals)
      if (!is_sound(Pose2{goal.position_m, goal.heading_rad.value_or(0.0)})) return false;
    return !go->goals.empty();
  }
  const auto* place = std::get_if<PlaceOrder>(&order.what);
  return place == nullptr || is_sound(place->map_from_base);
}

void talk(const std::string& text) {
  static const Site site = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  LiveLink link;
  LiveView view(site, &link);
  RosbridgeView bridge(site, link, view.lease());
  FoxgloveHub hub("fuzz", {{.topic = "/pose", .schema_name = "p", .schema = "{}", .every_message = true}});
  RobotState state;
  state.estimate = PoseEstimate{.map_from_base = {Vec2(1.2, 5.6), 0.0},
                                .covariance = Eigen::Vector3d(4e-6, 1e-6, 1e-4).asDiagonal()};
  const SocketProtocol live = view.protocols().front();
  const SocketProtocol ros = bridge.protocols().front();
  std::array clients{std::make_unique<Client>(live, Role::drive),
                     std::make_unique<Client>(live, Role::drive),
                     std::make_unique<Client>(live, Role::edit),
                     std::make_unique<Client>(live, Role::view),
                     std::make_unique<Client>(hub.protocols().front(), Role::view),
                     std::make_unique<Client>(ros, Role::drive),
                     std::make_unique<Client>(ros, Role::view)};
  const std::set<std::size_t> drivers{0, 1, 5};
  std::istringstream lines(text);
  Stamp now;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    const std::size_t who = static_cast<unsigned char>(line.front()) % clients.size();
    clients[who]->send(line.substr(1));
    hub.publish({.channel = 0, .stamp = now, .content = "{}"});
    view.pump(now += std::chrono::milliseconds(50), &state);
    bridge.pump(now, &state);
    for (const auto& client : clients) client->drain();
    const std::vector<Order> orders = link.take_orders();
    if (!orders.empty() && !drivers.contains(who))
      __builtin_trap();  // an order from a client that may not drive
    for (const Order& order : orders)
      if (!is_sound(order)) __builtin_trap();
  }
}

}  // namespace
}  // namespace lodestar

// The input is the messages of seven clients, one per line; the first byte selects the client (modulo 7: two
// that may drive, one that may edit, one that may look, one Foxglove viewer, two of rosbridge of which one
// may drive).
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lodestar::talk(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
