#include <atomic>
#include <future>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <latch>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "app/net/http_server.hpp"

#include "tests/app/net/raw_http.hpp"
#include "tests/app/net/socket_client.hpp"

// Requests that take long: a handler that lasts until the test lets it end, and who is served meanwhile.
namespace lodestar {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::chrono::seconds patience{10};

/// Answers every message with itself.
class Echo : public SocketSession {
 public:
  explicit Echo(Outbox& outbox) : outbox_(outbox) {}
  void receive(const std::string& bytes, bool /*binary*/) override { outbox_.queue(text_message(bytes)); }

 private:
  Outbox& outbox_;
};

SocketProtocol echo() {
  return {.name = "echo.v1", .open = [](Role, Outbox& outbox) { return std::make_unique<Echo>(outbox); }};
}

/// A handler for /long that lasts until it is let go or cancelled, and one for the rest that throws or
/// answers at once.
class Served {
 public:
  explicit Served(HttpServerOptions options = {})
      : server_(with_long_requests(std::move(options)),
                [this](const HttpRequest& request) { return answer(request); }, {echo()}),
        thread_([this] {
          while (!ended_) server_.run_for(std::chrono::milliseconds(5));
        }) {}
  ~Served() {
    ended_ = true;
    thread_.join();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  [[nodiscard]] unsigned short port() const { return server_.port(); }

  [[nodiscard]] std::string request(const std::string& target, const std::string& headers = "") const {
    return "POST " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port()) +
           "\r\nContent-Type: application/json\r\nX-Lodestar: 1\r\nContent-Length: 2\r\n" + headers +
           "\r\n{}";
  }

  /// The response to a request, which ends the connection.
  [[nodiscard]] std::string ask(const std::string& target, const std::string& headers = "") const {
    return exchange(port(), request(target, headers + "Connection: close\r\n"), patience).bytes;
  }
  [[nodiscard]] std::future<std::string> ask_beside(const std::string& target) const {
    return std::async(std::launch::async, [this, target] { return ask(target); });
  }

  void let_go() { may_end_.count_down(); }

  std::latch began{1};      ///< the first long request
  std::latch cancelled{1};  ///< a long request, before it was let go

 private:
  static HttpServerOptions with_long_requests(HttpServerOptions options) {
    options.takes_long = [](const HttpRequest& head) { return head.target.starts_with("/long"); };
    options.uses_files = [](const HttpRequest& head) { return head.target.starts_with("/file"); };
    return options;
  }

  HttpResponse answer(const HttpRequest& request) {
    if (request.target.ends_with("/throws")) throw std::runtime_error("no such word");
    if (request.target.ends_with("/throws-a-number")) throw 7;
    if (request.target == "/long" || request.target == "/file") {
      if (!has_begun_.exchange(true)) began.count_down();
      while (!may_end_.try_wait() && !request.cancelled.stop_requested()) std::this_thread::yield();
      if (!may_end_.try_wait()) cancelled.count_down();
    }
    return {.body = "{\"done\": \"" + request.target + "\"}"};
  }

  std::latch may_end_{1};
  std::atomic<bool> has_begun_ = false;
  HttpServer server_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

TEST(LongRequest, a_message_over_a_socket_does_not_wait_for_it) {
  Served served;
  SocketClient driver(served.port());
  ASSERT_THAT(driver.upgrade("echo.v1"), StartsWith("HTTP/1.1 101"));
  std::future<std::string> long_answer = served.ask_beside("/long");
  served.began.wait();
  driver.send("stop");
  EXPECT_EQ(driver.receive(), "stop");
  EXPECT_THAT(served.ask("/short"), StartsWith("HTTP/1.1 200"));
  served.let_go();
  EXPECT_THAT(long_answer.get(), HasSubstr("{\"done\": \"/long\"}"));
}

TEST(LongRequest, a_message_over_a_socket_does_not_wait_for_a_file_that_a_viewer_reads) {
  const std::string view = "view-view-view-view";
  Served served({.access = {.view_token = view}});
  const std::string bearer = "Authorization: Bearer " + view + "\r\n";
  SocketClient driver(served.port());
  ASSERT_THAT(driver.upgrade("echo.v1", bearer), StartsWith("HTTP/1.1 101"));
  std::vector<std::future<std::string>> files;
  for (int i = 0; i < 8; ++i)
    files.push_back(std::async(std::launch::async, [&] { return served.ask("/file", bearer); }));
  served.began.wait();
  driver.send("stop");
  EXPECT_EQ(driver.receive(), "stop");
  EXPECT_THAT(served.ask("/short", bearer), StartsWith("HTTP/1.1 200"));
  served.let_go();
  for (auto& file : files) EXPECT_THAT(file.get(), StartsWith("HTTP/1.1 200"));
}

TEST(LongRequest, is_refused_with_a_reason_when_too_many_wait) {
  Served served({.most_waiting = 0});
  std::future<std::string> first = served.ask_beside("/long");
  served.began.wait();
  const std::string refused = served.ask("/long");
  EXPECT_THAT(refused, StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(refused, HasSubstr("too much work of others"));
  served.let_go();
  EXPECT_THAT(first.get(), StartsWith("HTTP/1.1 200"));
  std::string later;  // the worker has answered, but may not have ended its job yet
  for (int i = 0; i < 1000 && later.find("200 OK") == std::string::npos; ++i) later = served.ask("/long");
  EXPECT_THAT(later, StartsWith("HTTP/1.1 200"));
}

TEST(LongRequest, answers_of_one_connection_come_in_its_order) {
  Served served;
  std::future<std::string> both = std::async(std::launch::async, [&] {
    return exchange(served.port(),
                    served.request("/long") + served.request("/short", "Connection: close\r\n"), patience)
        .bytes;
  });
  served.began.wait();
  served.let_go();
  const std::string bytes = both.get();
  ASSERT_THAT(bytes, HasSubstr("/short"));
  EXPECT_LT(bytes.find("/long"), bytes.find("/short"));
}

TEST(LongRequest, is_cancelled_when_its_client_leaves) {
  Served served;
  const int client = connected(served.port(), patience);
  const std::string request = served.request("/long");
  ASSERT_EQ(send(client, request.data(), request.size(), MSG_NOSIGNAL), std::ssize(request));
  served.began.wait();
  close(client);
  served.cancelled.wait();  // for ever, if it is not
  EXPECT_THAT(served.ask("/long/other"), StartsWith("HTTP/1.1 200"));
}

TEST(LongRequest, ends_with_the_server) {
  auto served = std::make_unique<Served>();
  const int client = connected(served->port(), patience);
  const std::string request = served->request("/long");
  ASSERT_EQ(send(client, request.data(), request.size(), MSG_NOSIGNAL), std::ssize(request));
  served->began.wait();
  served.reset();  // lasts for ever, if the handler is not told
  close(client);
}

TEST(LongRequest, needs_more_than_the_token_to_view) {
  const std::string view = "view-view-view-view";
  const std::string edit = "edit-edit-edit-edit";
  Served served({.access = {.edit_token = edit, .view_token = view}});
  served.let_go();
  const std::string bearer = "Authorization: Bearer ";
  EXPECT_THAT(served.ask("/long", bearer + view + "\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(served.ask("/long", bearer + edit + "\r\n"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(served.ask("/short", bearer + view + "\r\n"), StartsWith("HTTP/1.1 200"));
}

TEST(LongRequest, an_exception_answers_500_and_the_server_lives) {
  const Served served;
  for (const std::string where : {"", "/long"}) {
    EXPECT_THAT(served.ask(where + "/throws"), HasSubstr("no such word"));
    for (const std::string what : {"/throws", "/throws-a-number"})
      EXPECT_THAT(served.ask(where + what), StartsWith("HTTP/1.1 500")) << where << what;
  }
  EXPECT_THAT(served.ask("/short"), StartsWith("HTTP/1.1 200"));
}

}  // namespace
}  // namespace lodestar
