#include "app/console/live_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <thread>

#include "app/console/live_json.hpp"
#include "app/console/routes.hpp"
#include "drivers/system/clock.hpp"
#include "maps/input_error.hpp"

// Clients without sockets: their messages, what is queued for them, and the orders to the robot.
namespace lodestar {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Site lab() {
  return load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
}

Stamp at(double time_s) {
  return Stamp{} + from_seconds(time_s);
}

/// A localized robot that stands still.
RobotState standing(double x_m, double y_m) {
  RobotState state;
  state.estimate = PoseEstimate{.map_from_base = {Vec2(x_m, y_m), 0.0},
                                .covariance = Eigen::Vector3d(4e-6, 1e-6, 1e-4).asDiagonal()};
  state.base = BaseState::ready;
  return state;
}

/// One client of a view.
class Client {
 public:
  explicit Client(LiveView& view, Role role = Role::drive)
      : session_(view.protocols().front().open(role, outbox_)) {}

  void send(const json& message) const { session_->receive(message.dump(), false); }
  void send_text(const std::string& text) const { session_->receive(text, false); }

  /// The newest queued message of a type; null when there is none. Empties the queue.
  json newest(const std::string& type) {
    json found;
    while (const std::optional<SocketMessage> message = outbox_.take()) {
      if (message->binary) continue;
      json content = json::parse(*message->bytes);
      if (content["type"] == type) found = std::move(content);
    }
    return found;
  }

 private:
  Outbox outbox_;  // outlives the session
  std::unique_ptr<SocketSession> session_;
};

/// The client's next preview: the worker makes it, and a later turn of the server sends it.
json next_preview(LiveView& view, Client& client) {
  json preview;
  for (int i = 0; i < 2000 && preview.is_null(); ++i) {
    view.pump(at(10.0), nullptr);
    preview = client.newest("preview");
    if (preview.is_null()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return preview;
}

const json a_goal = json::parse("[[9.4, 1.2]]");

TEST(LiveView, says_hello_and_shows_the_newest_state_to_all) {
  const Site site = lab();
  LiveLink link;
  LiveView view(site, &link);
  Client first(view);
  Client second(view, Role::view);
  EXPECT_EQ(first.newest("hello")["role"], "drive");
  EXPECT_EQ(second.newest("hello")["role"], "view");
  RobotState state = standing(1.2, 5.6);
  state.path = std::make_shared<const Path>(Path{{Vec2(1.2, 5.6), Vec2(2.0, 5.0)}});
  for (const double x_m : {1.2, 1.3, 1.4}) {
    state.estimate->map_from_base.position_m.x() = x_m;
    view.pump(at(x_m), &state);
  }
  EXPECT_EQ(first.newest("state")["pose"]["x_m"], 1.4);
  const json path = second.newest("path");
  EXPECT_EQ(path["points"], json::parse("[[1.2, 5.6], [2.0, 5.0]]"));
  Client late(view);  // gets the newest state at once
  EXPECT_EQ(late.newest("state")["pose"]["x_m"], 1.4);
}

TEST(LiveView, lets_one_drive_at_a_time_and_everyone_stop) {
  const Site site = lab();
  LiveLink link;
  LiveView view(site, &link);
  Client first(view);
  Client second(view);
  Client viewer(view, Role::view);

  first.send({{"type", "go"}, {"goals", a_goal}});
  EXPECT_THAT(first.newest("refused")["why"], HasSubstr("does not have control"));
  first.send({{"type", "take"}});
  second.send({{"type", "take"}});
  EXPECT_THAT(second.newest("refused")["why"], HasSubstr("client 1"));
  viewer.send({{"type", "take"}});
  EXPECT_THAT(viewer.newest("refused")["why"], HasSubstr("token to drive"));
  EXPECT_THAT(link.take_orders(), IsEmpty());

  first.send({{"type", "go"}, {"goals", a_goal}});
  const std::vector<Order> orders = link.take_orders();
  ASSERT_EQ(orders.size(), 1U);
  EXPECT_EQ(std::get<GoOrder>(orders.front().what).goals.front().position_m, Vec2(9.4, 1.2));
  EXPECT_FALSE(link.take_stop());
  viewer.send({{"type", "stop"}});
  EXPECT_TRUE(link.take_stop());
  EXPECT_FALSE(link.take_stop());

  first.send({{"type", "release"}});
  second.send({{"type", "take"}});
  EXPECT_TRUE(second.newest("refused").is_null());
}

TEST(LiveView, what_is_ordered_once_takes_no_control_and_waits_for_who_has_it) {
  const Site site = lab();
  LiveLink link;
  LiveView view(site, &link);
  Client first(view);
  Client second(view);
  first.send({{"type", "place"}, {"pose", {1.0, 2.0, 90.0}}});
  first.send({{"type", "clear_fault"}});
  EXPECT_EQ(link.take_orders().size(), 2U);
  second.send({{"type", "take"}});  // free at once
  EXPECT_TRUE(second.newest("refused").is_null());
  second.send({{"type", "name"}, {"name", "Ada"}});
  first.send({{"type", "place"}, {"pose", {1.0, 2.0, 90.0}}});
  EXPECT_EQ(first.newest("refused")["why"], "client 2 (Ada) has control");
  EXPECT_THAT(link.take_orders(), IsEmpty());
}

TEST(LiveView, control_is_asked_for_and_handed_over_while_the_robot_is_held) {
  const Site site = lab();
  LiveLink link;
  LiveView view(site, &link);
  Client driver(view);
  Client other(view);
  Client viewer(view, Role::view);
  driver.send({{"type", "take"}});
  viewer.send({{"type", "ask"}});
  EXPECT_THAT(viewer.newest("refused")["why"], HasSubstr("token to drive"));
  other.send({{"type", "ask"}});
  EXPECT_EQ(driver.newest("asked")["client"], 2);
  other.send({{"type", "hand_over"}, {"client", 2}});  // not theirs to give
  EXPECT_THAT(other.newest("refused")["why"], HasSubstr("does not have control"));
  driver.send({{"type", "keep"}, {"client", 2}});
  EXPECT_EQ(other.newest("refused")["why"], "client 1 keeps control");
  driver.send({{"type", "hand_over"}, {"client", 3}});
  EXPECT_THAT(driver.newest("refused")["why"], HasSubstr("has left"));  // may not drive at all
  driver.send({{"type", "hand_over"}, {"client", 2}});
  EXPECT_FALSE(other.newest("control").is_null());
  EXPECT_TRUE(link.is_held(monotonic_now()));
  other.send({{"type", "pause"}});
  driver.send({{"type", "pause"}});
  EXPECT_EQ(link.take_orders().size(), 1U);
}

TEST(LiveView, says_what_the_scanner_sees_in_the_map_and_why_the_field_slows) {
  const Site site = lab();
  LiveLink link;
  LiveView view(site, &link);
  Client client(view);
  RobotState state = standing(1.0, 2.0);
  state.estimate->map_from_base.yaw_rad = radians(90.0);
  view.pump(at(1.0), &state);
  EXPECT_TRUE(client.newest("state")["field"].is_null());  // no scanner
  SeenSurroundings seen;
  seen.points = {{Vec2(2.0, 0.0), Presence::person}, {Vec2(0.0, 1.0), Presence::mapped}};
  seen.base_from_odom = {Vec2(0.5, 0.0), 0.0};
  seen.cell_m = 0.05;
  seen.cells = {{Vec2(1.0, 0.0), true}};
  state.seen = std::make_shared<const SeenSurroundings>(seen);
  state.slowed_by = StopReason::person_near;
  view.pump(at(2.0), &state);
  const json message = client.newest("seen");
  EXPECT_EQ(message["person"], json::parse("[1.0, 4.0]"));  // 2 m ahead, to the north
  EXPECT_EQ(message["mapped"], json::parse("[0.0, 2.0]"));
  EXPECT_EQ(message["cells_standing"], json::parse("[1.0, 3.5]"));
  EXPECT_EQ(message["cell_yaw_deg"], 90.0);
  view.pump(at(3.0), &state);
  EXPECT_EQ(client.newest("state")["field"],
            json::parse(R"({"state": "slowed", "why": "a person is too near"})"));
  state.stop = StopReason::person_near;
  view.pump(at(4.0), &state);
  EXPECT_EQ(client.newest("state")["field"]["state"], "stopped");
}

TEST(LiveView, a_stop_finds_its_way_when_no_order_does) {
  const Site site = lab();
  LiveLink link;
  LiveView view(site, &link);
  Client client(view);
  client.send({{"type", "take"}});
  for (int i = 0; i < 40; ++i) client.send({{"type", "pause"}});
  EXPECT_THAT(client.newest("refused")["why"], HasSubstr("too many orders are still waiting"));
  client.send({{"type", "stop"}});
  EXPECT_TRUE(link.take_stop());
}

TEST(LiveView, previews_the_way_or_says_why_there_is_none) {
  const Site site = lab();
  LiveLink link;
  LiveView view(site, &link);
  Client client(view);
  client.send({{"type", "preview"}, {"goals", a_goal}});
  EXPECT_THAT(next_preview(view, client)["why"], HasSubstr("does not know where it is"));

  const RobotState state = standing(1.2, 5.6);
  view.pump(at(2.0), &state);
  client.send({{"type", "preview"}, {"goals", json::parse("[[9.4, 1.2], [1.2, 5.6, 90]]")}});
  const json way = next_preview(view, client);
  EXPECT_GT(way["length_m"], 2 * 9.3);
  EXPECT_EQ(way["points"].back(), json::parse("[1.2, 5.6]"));
  client.send({{"type", "preview"}, {"goals", json::parse("[[2.0, 5.6], [3.3, 6.2]]")}});
  const json none = next_preview(view, client);
  EXPECT_EQ(none["goal"], 1);
  EXPECT_THAT(none["why"], HasSubstr("goal"));
  EXPECT_LT((Vec2(none["nearest"][0], none["nearest"][1]) - Vec2(3.3, 6.2)).norm(), 1.5);
}

TEST(LiveView, refuses_what_is_no_order_in_words_and_ends_with_what_is_no_message) {
  const Site site = lab();
  LiveLink link;
  LiveView view(site, &link);
  Client client(view);
  client.send({{"type", "take"}});
  for (const char* goals :
       {"[]", "[[1]]", "[[1, 2, 3, 4]]", "[[1e300, 2]]", "[[null, 2]]", "{}", "[[1, 2, 1e9]]", "7"}) {
    client.send({{"type", "go"}, {"goals", json::parse(goals)}});
    EXPECT_FALSE(client.newest("refused").is_null()) << goals;
  }
  client.send({{"type", "fly"}});
  EXPECT_EQ(client.newest("refused")["why"], "found an unknown message type");
  EXPECT_THAT(link.take_orders(), IsEmpty());
  for (const char* text :
       {"", "[", "[]", "7", "{}", "{\"type\": 7}", "{\"type\": \"go\"}", "{\"type\": \"camera\"}"}) {
    EXPECT_THROW(client.send_text(text), std::exception) << text;
  }
}

TEST(LiveView, without_a_robot_obeys_nobody) {
  const Site site = lab();
  LiveView view(site, nullptr);
  Client client(view);
  EXPECT_EQ(client.newest("hello")["robot"], false);
  client.send({{"type", "stop"}});
  EXPECT_THAT(client.newest("refused")["why"], HasSubstr("no robot"));
}

TEST(Lease, is_held_by_one_and_runs_out) {
  Lease lease(std::chrono::seconds(1));
  EXPECT_EQ(lease.holder(at(5.0)), std::nullopt);
  EXPECT_TRUE(lease.take(1, at(5.0)));
  EXPECT_FALSE(lease.take(2, at(5.9)));
  EXPECT_TRUE(lease.hold(1, at(5.9)));
  EXPECT_FALSE(lease.hold(2, at(6.0)));
  EXPECT_EQ(lease.holder(at(6.8)), 1);
  EXPECT_EQ(lease.holder(at(6.9)), std::nullopt);
  EXPECT_FALSE(lease.hold(1, at(7.0)));  // expired: the lease must be taken again
  EXPECT_TRUE(lease.take(2, at(7.0)));
  lease.release(1);
  EXPECT_EQ(lease.holder(at(7.1)), 2);
  lease.release(2);
  EXPECT_EQ(lease.holder(at(7.1)), std::nullopt);
}

TEST(LiveLink, gives_the_newest_state_once_and_only_when_wanted) {
  LiveLink link;
  EXPECT_FALSE(link.wants_state());
  link.want_state();
  EXPECT_TRUE(link.wants_state());
  link.publish(standing(1.0, 1.0));
  EXPECT_FALSE(link.wants_state());
  link.publish(standing(2.0, 1.0));
  EXPECT_EQ(link.newest()->estimate->map_from_base.position_m.x(), 2.0);
  EXPECT_FALSE(link.newest().has_value());
}

}  // namespace
}  // namespace lodestar
