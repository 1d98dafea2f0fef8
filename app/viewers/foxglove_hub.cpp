#include "app/viewers/foxglove_hub.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "app/common/json_parse.hpp"
#include "app/common/json_text.hpp"
#include "app/common/whole_number.hpp"

namespace lodestar {
namespace {

using Json = nlohmann::ordered_json;

std::uint32_t number_from(const nlohmann::json& value) {
  return whole_number(value, std::numeric_limits<std::uint32_t>::max());
}

/// Message Data: its operation code, the subscription, the time in nanoseconds, the message; little-endian.
SocketMessage data_frame(std::uint32_t subscription, const Message& message) {
  constexpr char message_data = 0x01;
  std::string bytes(1, message_data);
  const auto append = [&bytes](std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i)
      bytes += static_cast<char>((value >> (8U * static_cast<unsigned>(i))) & 0xFFU);
  };
  append(subscription, sizeof subscription);
  append(static_cast<std::uint64_t>(std::max<std::int64_t>(message.stamp.time_since_epoch().count(), 0)),
         sizeof(std::uint64_t));
  bytes += message.content;
  return {.bytes = std::make_shared<const std::string>(std::move(bytes)), .binary = true};
}

}  // namespace

/// One client and its subscriptions, by channel: at most one per channel.
class FoxgloveHub::Viewer : public SocketSession {
 public:
  Viewer(FoxgloveHub& hub, Outbox& outbox) : hub_(hub), outbox_(outbox) {
    hub_.viewers_.insert(this);
    outbox_.queue(text_message(hub_.server_info()));
    outbox_.queue(text_message(hub_.advertisement()));
  }
  ~Viewer() override { hub_.viewers_.erase(this); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void receive(const std::string& bytes, bool binary) override {
    if (binary) return complain("this server takes no messages from viewers");
    const auto request = parse_json(bytes);
    const auto operation = request.at("op").get<std::string>();
    if (operation == "subscribe") {
      for (const auto& wish : request.at("subscriptions"))
        subscribe(number_from(wish.at("id")), number_from(wish.at("channelId")));
    } else if (operation == "unsubscribe") {
      for (const auto& id : request.at("subscriptionIds")) unsubscribe(number_from(id));
    } else {
      complain(fmt::format("this server does not know '{}'", operation.substr(0, 40)));
    }
  }

  [[nodiscard]] bool hears(std::size_t channel) const { return subscriptions_.contains(channel); }

  void show(const Message& message) {
    const auto subscription = subscriptions_.find(message.channel);
    if (subscription == subscriptions_.end()) return;
    SocketMessage frame = data_frame(subscription->second, message);
    if (hub_.channels_[message.channel].every_message) return outbox_.queue(std::move(frame));
    outbox_.offer(static_cast<int>(message.channel), std::move(frame));
  }

 private:
  void subscribe(std::uint32_t id, std::size_t channel) {
    if (channel >= hub_.channels_.size() || !hub_.channels_[channel].is_live)
      return complain(fmt::format("no channel {}", channel));
    const bool is_used = std::ranges::any_of(subscriptions_, [id](const auto& s) { return s.second == id; });
    if (is_used || !subscriptions_.try_emplace(channel, id).second) {
      return complain(fmt::format("channel {} or subscription {} twice", channel, id));
    }
    if (hub_.newest_[channel]) show(*hub_.newest_[channel]);
  }

  void unsubscribe(std::uint32_t id) {
    if (std::erase_if(subscriptions_, [id](const auto& s) { return s.second == id; }) == 0) {
      complain(fmt::format("no subscription {}", id));
    }
  }

  void complain(const std::string& words) {
    constexpr int warning = 1;
    const Json status{{"op", "status"}, {"level", warning}, {"message", words}};
    outbox_.queue(text_message(json_text(status)));
  }

  FoxgloveHub& hub_;
  Outbox& outbox_;
  std::map<std::size_t, std::uint32_t> subscriptions_;
};

FoxgloveHub::FoxgloveHub(std::string name, std::vector<Channel> channels)
    : name_(std::move(name)),
      session_(fmt::format("{:08x}", std::random_device{}())),
      channels_(std::move(channels)),
      newest_(channels_.size()) {}

std::vector<SocketProtocol> FoxgloveHub::protocols() {
  std::vector<SocketProtocol> protocols;
  for (const char* name : {"foxglove.sdk.v1", "foxglove.websocket.v1"}) {
    protocols.push_back({.name = name, .open = [this](Role /*any may view*/, Outbox& outbox) {
                           return std::unique_ptr<SocketSession>(std::make_unique<Viewer>(*this, outbox));
                         }});
  }
  return protocols;
}

void FoxgloveHub::publish(const Message& message) {
  newest_.at(message.channel) = message;
  for (Viewer* const viewer : viewers_) viewer->show(message);
}

bool FoxgloveHub::is_heard(std::size_t channel) const {
  return std::ranges::any_of(viewers_, [&](const Viewer* viewer) { return viewer->hears(channel); });
}

std::string FoxgloveHub::server_info() const {
  return json_text(Json{{"op", "serverInfo"},
                        {"name", name_},
                        {"capabilities", Json::array()},
                        {"supportedEncodings", {"json"}},
                        {"metadata", Json::object()},
                        {"sessionId", session_}});
}

std::string FoxgloveHub::advertisement() const {
  Json channels = Json::array();
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    if (!channels_[id].is_live) continue;
    channels.push_back({{"id", id},
                        {"topic", channels_[id].topic},
                        {"encoding", "json"},
                        {"schemaName", channels_[id].schema_name},
                        {"schemaEncoding", "jsonschema"},
                        {"schema", channels_[id].schema}});
  }
  return json_text(Json{{"op", "advertise"}, {"channels", channels}});
}

}  // namespace lodestar
