#include "app/net/socket.hpp"

#include <algorithm>
#include <set>
#include <sstream>

namespace lodestar {

SocketMessage text_message(std::string text) {
  return {.bytes = std::make_shared<const std::string>(std::move(text))};
}

void Outbox::queue(SocketMessage message) {
  append({.slot = std::nullopt, .message = std::move(message)});
}

void Outbox::offer(int slot, SocketMessage message) {
  const auto same = std::ranges::find(waiting_, std::optional<int>(slot), &Waiting::slot);
  if (same == waiting_.end()) return append({.slot = slot, .message = std::move(message)});
  bytes_ += message.bytes->size() - same->message.bytes->size();
  same->message = std::move(message);
  ++dropped_;
}

void Outbox::append(Waiting waiting) {
  if (overflowed_) return;
  bytes_ += waiting.message.bytes->size();
  waiting_.push_back(std::move(waiting));
  overflowed_ = waiting_.size() > limits_.most_messages || bytes_ > limits_.most_bytes;
  if (wake_) wake_();
}

std::optional<SocketMessage> Outbox::take() {
  if (waiting_.empty()) return std::nullopt;
  SocketMessage message = std::move(waiting_.front().message);
  waiting_.pop_front();
  bytes_ -= message.bytes->size();
  return message;
}

const SocketProtocol* chosen_protocol(const std::vector<SocketProtocol>& protocols,
                                      const std::string& offered) {
  std::set<std::string> names;
  std::istringstream list(offered);
  for (std::string name; std::getline(list, name, ',');) {
    const std::size_t first = std::min(name.find_first_not_of(" \t"), name.size());
    names.insert(name.substr(first, name.find_last_not_of(" \t") + 1 - first));
  }
  if (names.empty()) names.insert("");
  const auto found = std::ranges::find_if(
      protocols, [&](const SocketProtocol& protocol) { return names.contains(protocol.name); });
  return found == protocols.end() ? nullptr : &*found;
}

}  // namespace lodestar
