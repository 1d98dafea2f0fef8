#include "app/net/http_server.hpp"

#include <atomic>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "maps/input_error.hpp"

#include "tests/app/net/raw_http.hpp"

// A server on loopback and hostile clients, which send raw bytes that no library corrects.
namespace lodestar {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string token = "0123456789abcdef0123456789abcdef";

class Served {
 public:
  explicit Served(HttpServerOptions options)
      : server_(options,
                [this](const HttpRequest& request) {
                  ++handled;
                  return HttpResponse{.body = "{\"got\": \"" + request.method + "\"}"};
                }),
        thread_([this] {
          while (!ended_) server_.run_for(std::chrono::milliseconds(20));
        }) {}
  ~Served() {
    ended_ = true;
    thread_.join();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  [[nodiscard]] unsigned short port() const { return server_.port(); }
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(port()); }

  /// The whole response to these bytes, until the server closes or nothing arrives for 2 s.
  [[nodiscard]] std::string send(const std::string& bytes) const {
    return exchange(port(), bytes, std::chrono::seconds(2)).bytes;
  }

  /// A request with these headers, the connection closed after it.
  [[nodiscard]] std::string ask(const std::string& line, const std::string& headers,
                                const std::string& body = "") const {
    return send(line + " HTTP/1.1\r\nConnection: close\r\n" + headers +
                (body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n") + "\r\n" +
                body);
  }

  std::atomic<int> handled = 0;

 private:
  HttpServer server_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

const std::string json_of_ours = "Content-Type: application/json\r\nX-Lodestar: 1\r\n";

TEST(HttpServer, answers_its_own_page_and_says_what_a_browser_must_not_do) {
  const Served served({});
  const std::string answer = served.ask("GET /", "Host: " + served.host() + "\r\n");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(answer, HasSubstr("{\"got\": \"GET\"}"));
  EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self'"));
  EXPECT_THAT(answer, HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(answer, Not(HasSubstr("Access-Control")));
}

TEST(HttpServer, answers_to_the_host_names_that_it_was_given) {
  const Served served({.access = {.host_names = {"robot", "robot.local"}}});
  const std::string port = std::to_string(served.port());
  for (const std::string name : {"robot", "Robot.local"})
    EXPECT_THAT(served.ask("GET /api/site", "Host: " + name + ":" + port + "\r\n"),
                StartsWith("HTTP/1.1 200"))
        << name;
  for (const std::string name : {"robot.evil.example", "robot.local.evil.example", "evil-robot"})
    EXPECT_THAT(served.ask("GET /api/site", "Host: " + name + ":" + port + "\r\n"),
                StartsWith("HTTP/1.1 403"))
        << name;
}

TEST(HttpServer, refuses_another_name_for_this_machine) {
  const Served served({});
  const std::string port = std::to_string(served.port());
  for (const std::string& host : {"evil.example:" + port, std::string("127.0.0.1"), std::string(""),
                                  "127.0.0.1.evil.example:" + port, "127.0.0.1:1" + port}) {
    EXPECT_THAT(served.ask("GET /api/site", "Host: " + host + "\r\n"), StartsWith("HTTP/1.1 403")) << host;
  }
  EXPECT_THAT(served.ask("GET /api/site", ""), StartsWith("HTTP/1.1 403"));
  EXPECT_EQ(served.handled, 0);
  EXPECT_THAT(served.ask("GET /api/site", "Host: localhost:" + port + "\r\n"), StartsWith("HTTP/1.1 200"));
}

TEST(HttpServer, refuses_pages_of_other_origins) {
  const Served served({});
  const std::string host = "Host: " + served.host() + "\r\n";
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1", "http://127.0.0.1:1"}) {
    EXPECT_THAT(served.ask("GET /api/site", host + "Origin: " + origin + "\r\n"), StartsWith("HTTP/1.1 403"))
        << origin;
  }
  // What a form on another site can send without a preflight: no X-Lodestar, no JSON.
  EXPECT_THAT(served.ask("POST /api/markers/check", host + "Content-Type: application/json\r\n", "{}"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(
      served.ask("POST /api/markers/check", host + "X-Lodestar: 1\r\nContent-Type: text/plain\r\n", "{}"),
      StartsWith("HTTP/1.1 415"));
  EXPECT_THAT(served.ask("OPTIONS /api/markers", host), StartsWith("HTTP/1.1 403"));
  EXPECT_EQ(served.handled, 0);
  EXPECT_THAT(
      served.ask("PUT /api/markers", host + json_of_ours + "Origin: http://" + served.host() + "\r\n", "{}"),
      StartsWith("HTTP/1.1 200"));
}

TEST(HttpServer, asks_for_the_token_and_takes_no_other) {
  const Served served({.access = {.token = token}});
  const std::string host = "Host: " + served.host() + "\r\n";
  EXPECT_THAT(served.ask("GET /api/site", host), StartsWith("HTTP/1.1 401"));
  for (const std::string& wrong : {std::string(), token + "0", token.substr(1), std::string(32, '0')}) {
    EXPECT_THAT(served.ask("GET /api/site", host + "Authorization: Bearer " + wrong + "\r\n"),
                StartsWith("HTTP/1.1 401"));
    EXPECT_THAT(served.ask("GET /api/site", host + "Cookie: a=1; lodestar=" + wrong + "\r\n"),
                StartsWith("HTTP/1.1 401"));
    EXPECT_THAT(served.ask("POST /api/session", host + json_of_ours, "{\"token\": \"" + wrong + "\"}"),
                StartsWith("HTTP/1.1 401"));
  }
  EXPECT_EQ(served.handled, 0);
  EXPECT_THAT(served.ask("GET /api/site", host + "Authorization: Bearer " + token + "\r\n"),
              StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(served.ask("GET /api/site", host + "Cookie: a=1; lodestar=" + token + "; b=2\r\n"),
              StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(served.ask("POST /api/session", host + json_of_ours, "{\"token\": \"" + token + "\"}"),
              HasSubstr("Set-Cookie: lodestar=" + token + "; Path=/; HttpOnly; SameSite=Strict"));
}

TEST(HttpServer, listens_beyond_loopback_only_with_a_token) {
  const auto handler = [](const HttpRequest&) { return HttpResponse{}; };
  EXPECT_THROW(HttpServer({.access = {.bind = "0.0.0.0"}}, handler), InputError);
  EXPECT_NO_THROW(HttpServer({.access = {.bind = "0.0.0.0", .token = token}}, handler));
  EXPECT_THROW(HttpServer({.access = {.bind = "robot.example", .token = token}}, handler), InputError);
  const HttpServer first({}, handler);
  EXPECT_TRUE(is_loopback("127.0.0.1"));
  EXPECT_FALSE(is_loopback("127.evil.example"));
}

TEST(HttpServer, takes_no_more_than_its_limits) {
  const Served served({.max_body_bytes = 1000});
  const std::string head = "Host: " + served.host() + "\r\n" + json_of_ours;
  EXPECT_THAT(served.ask("PUT /api/markers", head, std::string(1001, 'x')), StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(
      served.send("PUT /api/markers HTTP/1.1\r\n" + head + "Transfer-Encoding: chunked\r\n\r\n7D0\r\n" +
                  std::string(2000, 'x') + "\r\n0\r\n\r\n"),
      StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(served.ask("GET /", head + "X-Long: " + std::string(20000, 'x') + "\r\n"),
              StartsWith("HTTP/1.1 431"));
  EXPECT_EQ(served.handled, 0);
  EXPECT_THAT(served.ask("PUT /api/markers", head, std::string(1000, 'x')), StartsWith("HTTP/1.1 200"));
}

TEST(HttpServer, survives_what_is_no_http) {
  const Served served({});
  for (const std::string& bytes :
       {std::string("\r\n\r\n"), std::string("GET\r\n\r\n"), std::string(3000, '\0'),
        std::string("\x16\x03\x01\x02"),
        "GET / HTTP/1.1\r\nHost: " + served.host() + "\r\nContent-Length: -1\r\n\r\n",
        std::string("PUT / HTTP/1.1\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n")}) {
    EXPECT_THAT(served.send(bytes), Not(HasSubstr("200 OK")));
  }
  EXPECT_THAT(served.ask("GET /", "Host: " + served.host() + "\r\n"), StartsWith("HTTP/1.1 200"));
}

TEST(HttpServer, lets_nobody_hold_all_its_connections_for_long) {
  const Served served({.max_connections = 4, .patience = std::chrono::seconds(1)});
  const std::string never_finished = "GET / HTTP/1.1\r\nHost: ";
  std::atomic<int> turned_out = 0;
  std::vector<std::thread> idlers;
  for (int i = 0; i < 4; ++i) {
    idlers.emplace_back([&] {
      // Far longer than the server's timeout: the server must close.
      if (exchange(served.port(), never_finished, std::chrono::seconds(20)).ended_by_server) ++turned_out;
    });
  }
  for (std::thread& idler : idlers) idler.join();
  EXPECT_EQ(turned_out, 4);
  EXPECT_THAT(served.ask("GET /", "Host: " + served.host() + "\r\n"), StartsWith("HTTP/1.1 200"));
}

TEST(HttpServer, shuts_nobody_out_for_those_that_connect_and_send_nothing) {
  std::vector<int> idlers;
  {
    const Served served({.max_connections = 8, .patience = std::chrono::seconds(60)});
    const std::string host = "Host: " + served.host() + "\r\n";
    const std::string half = "POST / HTTP/1.1\r\n" + host + json_of_ours + "Content-Length: 9\r\n\r\n1";
    for (int i = 0; i < 60; ++i) {
      idlers.push_back(connected(served.port(), std::chrono::seconds(2)));
      if (i % 2 == 0) {
        ASSERT_EQ(::send(idlers.back(), half.data(), half.size(), MSG_NOSIGNAL), std::ssize(half));
      }
      if (i % 5 == 0) {
        EXPECT_THAT(served.ask("GET /", host), StartsWith("HTTP/1.1 200")) << i;
      }
    }
    EXPECT_EQ(served.handled, 12);
  }  // it ends while clients are still there
  for (const int idler : idlers) ::close(idler);
}

TEST(Access, compares_tokens_whole) {
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abcd"));
  EXPECT_FALSE(equal_in_constant_time("abcd", "abc"));
  EXPECT_FALSE(equal_in_constant_time("", "abc"));
}

}  // namespace
}  // namespace lodestar
