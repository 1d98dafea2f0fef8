#include "app/net/socket.hpp"

#include <atomic>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <thread>

#include "app/net/http_server.hpp"

#include "tests/app/net/socket_client.hpp"

// Values published to clients of all kinds: ones that read, ones that never read, and unauthorized ones.
namespace lodestar {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string view_token = "view-view-view-view";
const std::string drive_token = "drive-drive-drive-drive";

/// Sends its role, then echoes what it receives, and sends a value of slot 1 with every publish().
class Echo {
 public:
  [[nodiscard]] SocketProtocol protocol() {
    return {.name = "echo.v1", .open = [this](Role role, Outbox& outbox) -> std::unique_ptr<SocketSession> {
              return std::make_unique<Session>(*this, role, outbox);
            }};
  }

  void publish(const std::string& value) {
    for (Outbox* const outbox : outboxes_) outbox->offer(1, text_message(value));
    if (!outboxes_.empty()) dropped = outboxes_.front()->dropped();
  }

  std::atomic<int> clients = 0;
  std::atomic<std::uint64_t> dropped = 0;

 private:
  class Session : public SocketSession {
   public:
    Session(Echo& echo, Role role, Outbox& outbox) : echo_(echo), outbox_(outbox) {
      echo_.outboxes_.push_back(&outbox_);
      ++echo_.clients;
      outbox_.queue(text_message(std::string(to_string(role))));
    }
    ~Session() override {
      std::erase(echo_.outboxes_, &outbox_);
      --echo_.clients;
    }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    void receive(const std::string& bytes, bool binary) override {
      if (bytes == "nonsense") throw std::runtime_error("no such word");
      outbox_.queue({.bytes = std::make_shared<const std::string>(bytes), .binary = binary});
    }

   private:
    Echo& echo_;
    Outbox& outbox_;
  };

  std::vector<Outbox*> outboxes_;
};

/// A server that publishes a value of this size in every cycle.
class Served {
 public:
  explicit Served(HttpServerOptions options = {}, std::size_t value_bytes = 0)
      : server_(options, [](const HttpRequest&) { return HttpResponse{.body = "{}"}; }, {echo.protocol()}),
        thread_([this, value = std::string(value_bytes, 'v')] {
          while (!ended_) {
            server_.run_for(std::chrono::milliseconds(5));
            if (!value.empty()) echo.publish(value);
            ++turns;
          }
        }) {}
  ~Served() {
    ended_ = true;
    thread_.join();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  [[nodiscard]] unsigned short port() const { return server_.port(); }
  [[nodiscard]] std::string ours() const {
    return "Origin: http://127.0.0.1:" + std::to_string(port()) + "\r\n";
  }

  /// Waits up to 10 s for the condition.
  template <typename Condition>
  [[nodiscard]] bool soon(Condition condition) const {
    for (int i = 0; i < 1000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
  }

  Echo echo;
  std::atomic<int> turns = 0;

 private:
  HttpServer server_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

TEST(Socket, talks_with_who_offers_a_subprotocol_of_ours) {
  const Served served;
  SocketClient client(served.port());
  const std::string head = client.upgrade("other.v7, echo.v1", served.ours());
  EXPECT_THAT(head, StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(head, HasSubstr("Sec-WebSocket-Protocol: echo.v1"));
  EXPECT_EQ(client.receive(), "drive");
  for (const std::size_t size : {1U, 125U, 126U, 60000U}) {
    client.send(std::string(size, 'x'));
    EXPECT_EQ(client.receive(), std::string(size, 'x'));
  }
  SocketClient mute(served.port());
  EXPECT_THAT(mute.upgrade("other.v7", served.ours()), StartsWith("HTTP/1.1 400"));
}

TEST(Socket, refuses_other_pages_other_names_and_other_tokens_before_the_upgrade) {
  const Served served({.access = {.token = drive_token, .view_token = view_token}});
  const auto answer = [&](const std::string& headers) {
    SocketClient client(served.port());
    return client.upgrade("echo.v1", headers);
  };
  const std::string bearer = "Authorization: Bearer ";
  const std::string good = bearer + drive_token + "\r\n";
  EXPECT_THAT(answer(good + "Origin: http://evil.example\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(answer(good + "Host: evil.example:" + std::to_string(served.port()) + "\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(answer(served.ours()), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(answer(bearer + "guess-guess-guess\r\n"), StartsWith("HTTP/1.1 401"));
  EXPECT_EQ(served.echo.clients, 0);
  for (const auto& [token, role] : {std::pair(view_token, "view"), std::pair(drive_token, "drive")}) {
    SocketClient client(served.port());
    EXPECT_THAT(client.upgrade("echo.v1", "Cookie: lodestar=" + token + "\r\n" + served.ours()),
                StartsWith("HTTP/1.1 101"));
    EXPECT_EQ(client.receive(), role);
  }
}

TEST(Socket, turns_out_who_sends_too_much_nonsense_or_unmasked_frames) {
  const Served served({.max_socket_message_bytes = 1000});
  const auto is_turned_out = [&](const std::function<void(SocketClient&)>& misbehave) {
    SocketClient client(served.port());
    (void)client.upgrade("echo.v1");
    EXPECT_EQ(client.receive(), "drive");
    misbehave(client);
    return !client.receive().has_value();
  };
  EXPECT_TRUE(is_turned_out([](SocketClient& client) { client.send(std::string(1001, 'x')); }));
  EXPECT_TRUE(is_turned_out(
      [](SocketClient& client) { client.send_bytes("\x82\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFFmask"); }));
  EXPECT_TRUE(is_turned_out([](SocketClient& client) { client.send("nonsense"); }));
  EXPECT_TRUE(is_turned_out([](SocketClient& client) { client.send_bytes(std::string("\x81\x02hi")); }));
  EXPECT_TRUE(served.soon([&] { return served.echo.clients == 0; }));
}

TEST(Socket, a_client_that_never_reads_holds_up_nobody_and_is_turned_out) {
  const Served served({.patience = std::chrono::seconds(1)}, 200'000);
  SocketClient sleeper(served.port());
  (void)sleeper.upgrade("echo.v1");
  ASSERT_TRUE(served.soon([&] { return served.echo.dropped > 5; }));  // values for it are dropped
  SocketClient reader(served.port());
  (void)reader.upgrade("echo.v1");
  EXPECT_EQ(reader.receive(), "drive");
  for (int i = 0; i < 20; ++i) EXPECT_EQ(reader.receive().value_or("").size(), 200'000U);
  // Only the client that reads, and so answers pings, stays connected.
  const bool one_left = served.soon([&] {
    (void)reader.receive();
    return served.echo.clients == 1;
  });
  EXPECT_TRUE(one_left);
  EXPECT_TRUE(reader.receive().has_value());
}

TEST(Socket, takes_no_more_clients_than_it_may) {
  const Served served({.max_sockets = 2});
  SocketClient first(served.port());
  SocketClient second(served.port());
  SocketClient third(served.port());
  EXPECT_THAT(first.upgrade("echo.v1"), StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(second.upgrade("echo.v1"), StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(third.upgrade("echo.v1"), StartsWith("HTTP/1.1 503"));
}

TEST(Socket, keeps_room_for_who_drives_however_many_only_look) {
  const Served served({.access = {.token = drive_token, .view_token = view_token}, .max_sockets = 4});
  const std::string bearer = served.ours() + "Authorization: Bearer ";
  std::vector<std::unique_ptr<SocketClient>> viewers;
  for (int i = 0; i < 6; ++i) {
    viewers.push_back(std::make_unique<SocketClient>(served.port()));
    EXPECT_THAT(viewers.back()->upgrade("echo.v1", bearer + view_token + "\r\n"),
                StartsWith(i < 3 ? "HTTP/1.1 101" : "HTTP/1.1 503"));
  }
  SocketClient driver(served.port());
  EXPECT_THAT(driver.upgrade("echo.v1", bearer + drive_token + "\r\n"), StartsWith("HTTP/1.1 101"));
}

TEST(Outbox, keeps_order_replaces_values_and_overflows) {
  Outbox outbox({.most_messages = 3, .most_bytes = 100});
  outbox.queue(text_message("a"));
  outbox.offer(1, text_message("old"));
  outbox.queue(text_message("b"));
  outbox.offer(1, text_message("new"));
  EXPECT_EQ(outbox.dropped(), 1U);
  for (const char* expected : {"a", "new", "b"}) EXPECT_EQ(*outbox.take()->bytes, expected);
  EXPECT_FALSE(outbox.take().has_value());
  outbox.queue(text_message(std::string(100, 'x')));
  EXPECT_FALSE(outbox.overflowed());
  outbox.queue(text_message("y"));
  EXPECT_TRUE(outbox.overflowed());
}

}  // namespace
}  // namespace lodestar
