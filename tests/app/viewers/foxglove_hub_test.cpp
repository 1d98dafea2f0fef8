#include "app/viewers/foxglove_hub.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

// The protocol over a real socket is checked with a third-party client, in tests/web/foxglove_test.mjs.
namespace lodestar {
namespace {

using nlohmann::json;

std::vector<Channel> three_channels() {
  return {{.topic = "/pose", .schema_name = "a", .schema = "{}"},
          {.topic = "/log", .schema_name = "b", .schema = "{}", .every_message = true},
          {.topic = "/truth", .schema_name = "c", .schema = "{}", .is_live = false}};
}

Message said(std::size_t channel, const std::string& words, std::int64_t ns = 0) {
  return {.channel = channel, .stamp = Stamp(Duration(ns)), .content = words};
}

class FoxgloveHubTest : public testing::Test {
 protected:
  void join() {
    viewer = hub.protocols().front().open(Role::view, outbox);
    info = json::parse(*outbox.take()->bytes);
    advertised = json::parse(*outbox.take()->bytes);
  }
  void tell(const json& request) const { viewer->receive(request.dump(), false); }
  void subscribe(int id, int channel) const {
    tell({{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}});
  }
  /// The message in the next data frame; nothing when none is queued.
  std::optional<std::string> next() {
    const std::optional<SocketMessage> frame = outbox.take();
    if (!frame) return std::nullopt;
    return frame->binary ? frame->bytes->substr(13) : *frame->bytes;
  }

  FoxgloveHub hub{"test", three_channels()};
  Outbox outbox;
  std::unique_ptr<SocketSession> viewer;
  json info;
  json advertised;
};

TEST_F(FoxgloveHubTest, a_viewer_is_told_what_there_is) {
  join();
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["capabilities"], json::array());
  EXPECT_EQ(advertised["op"], "advertise");
  ASSERT_EQ(advertised["channels"].size(), 2U);
  EXPECT_EQ(advertised["channels"][1]["id"], 1);
  EXPECT_EQ(advertised["channels"][1]["topic"], "/log");
  EXPECT_EQ(advertised["channels"][1]["schemaEncoding"], "jsonschema");
}

TEST_F(FoxgloveHubTest, a_channel_that_only_files_have_is_neither_told_nor_given) {
  join();
  for (const json& channel : advertised["channels"]) EXPECT_NE(channel["topic"], "/truth");
  subscribe(1, 2);
  EXPECT_EQ(json::parse(next().value())["message"], "no channel 2");
}

TEST_F(FoxgloveHubTest, frames_carry_subscription_time_and_message) {
  join();
  subscribe(0x01020304, 0);
  hub.publish(said(0, "{}", 0x0807060504030201));
  const std::optional<SocketMessage> frame = outbox.take();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->binary);
  EXPECT_EQ(*frame->bytes, std::string("\x01\x04\x03\x02\x01\x01\x02\x03\x04\x05\x06\x07\x08{}", 15));
}

TEST_F(FoxgloveHubTest, nobody_gets_what_he_did_not_ask_for) {
  join();
  hub.publish(said(0, "early"));
  EXPECT_FALSE(next());
  subscribe(7, 0);
  EXPECT_EQ(next(), "early");  // the current value
  tell({{"op", "unsubscribe"}, {"subscriptionIds", {7}}});
  hub.publish(said(0, "late"));
  EXPECT_FALSE(next());
}

TEST_F(FoxgloveHubTest, a_slow_viewer_gets_the_newest_value_and_every_event) {
  join();
  subscribe(1, 0);
  subscribe(2, 1);
  for (const char* word : {"a", "b", "c"}) {
    hub.publish(said(0, word));
    hub.publish(said(1, word));
  }
  EXPECT_EQ(next(), "c");
  for (const char* word : {"a", "b", "c"}) EXPECT_EQ(next(), word);
  EXPECT_FALSE(next());
}

TEST_F(FoxgloveHubTest, wrong_wishes_are_answered_in_words) {
  join();
  subscribe(1, 0);
  subscribe(1, 1);  // subscription ID already in use
  subscribe(2, 0);  // channel already subscribed
  subscribe(3, 99);
  tell({{"op", "advertise"}, {"channels", json::array()}});
  tell({{"op", "unsubscribe"}, {"subscriptionIds", {55}}});
  viewer->receive("\x01", true);
  for (int i = 0; i < 6; ++i) {
    const json answer = json::parse(next().value());
    EXPECT_EQ(answer["op"], "status") << answer;
    EXPECT_EQ(answer["level"], 1);
  }
  EXPECT_FALSE(next());
}

TEST_F(FoxgloveHubTest, nonsense_ends_the_session_and_the_hub_goes_on) {
  join();
  EXPECT_THROW(viewer->receive("no json", false), std::exception);
  EXPECT_THROW(tell({{"op", "subscribe"}}), std::exception);
  for (const json& number : {json("x"), json(true), json(-1), json(1.5), json(1e20), json(4294967296)}) {
    EXPECT_THROW(tell({{"op", "subscribe"}, {"subscriptions", {{{"id", number}, {"channelId", 0}}}}}),
                 std::exception)
        << number;
    EXPECT_THROW(tell({{"op", "subscribe"}, {"subscriptions", {{{"id", 1}, {"channelId", number}}}}}),
                 std::exception)
        << number;
    EXPECT_THROW(tell({{"op", "unsubscribe"}, {"subscriptionIds", {number}}}), std::exception) << number;
  }
  EXPECT_TRUE(hub.has_viewers());
  viewer.reset();
  EXPECT_FALSE(hub.has_viewers());
  hub.publish(said(0, "to nobody"));
}

}  // namespace
}  // namespace lodestar
