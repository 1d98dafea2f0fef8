#pragma once

#include <string>

#include "app/common/json_parse.hpp"
#include "app/net/socket.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {

/// One client of a view, which sends JSON. The view, of which this is a friend, keeps a `Client` with its
/// role and its outbox from add_client() to remove_client(), and handles its messages in receive().
template <typename View>
class ViewSession : public SocketSession {
 public:
  ViewSession(View& view, Role role, Outbox& outbox) : view_(view) {
    client_.role = role;
    client_.outbox = &outbox;
    view_.add_client(client_);
  }
  ~ViewSession() override { view_.remove_client(client_); }
  ViewSession(const ViewSession&) = delete;
  ViewSession& operator=(const ViewSession&) = delete;

  void receive(const std::string& bytes, bool /*binary*/) override {
    view_.receive(client_, parse_json(bytes), monotonic_now());
  }

 private:
  View& view_;
  typename View::Client client_;
};

}  // namespace lodestar
