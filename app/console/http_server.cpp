#include "app/console/http_server.hpp"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using beast::error_code;

using Parser = http::request_parser<http::string_body>;
using Message = http::response<http::string_body>;

std::string text(beast::string_view view) {
  return {view.data(), view.size()};
}

HttpRequest head_of(const Parser& parser) {
  const auto& fields = parser.get();
  return {.method = text(fields.method_string()),
          .target = text(fields.target()),
          .host = text(fields[http::field::host]),
          .origin = text(fields[http::field::origin]),
          .content_type = text(fields[http::field::content_type]),
          .console_header = text(fields["X-Lodestar"]),
          .authorization = text(fields[http::field::authorization]),
          .cookie = text(fields[http::field::cookie]),
          .if_match = text(fields[http::field::if_match]),
          .if_none_match = text(fields[http::field::if_none_match])};
}

/// Nothing from elsewhere, no script but our own file, no frame around us: whatever a document's text holds.
void add_safety(Message& message) {
  message.set("Content-Security-Policy",
              "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
              "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  message.set("X-Content-Type-Options", "nosniff");
  message.set("X-Frame-Options", "DENY");
  message.set("Referrer-Policy", "no-referrer");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
  message.set(http::field::cache_control, "no-cache");
}

Message message_of(HttpResponse response, bool keep_alive, bool without_body) {
  Message message(static_cast<http::status>(response.status), 11);
  message.set(http::field::content_type, response.content_type);
  add_safety(message);
  if (!response.etag.empty()) message.set(http::field::etag, response.etag);
  if (!response.set_cookie.empty()) message.set(http::field::set_cookie, response.set_cookie);
  message.keep_alive(keep_alive);
  if (response.status == 304) return message;
  const std::size_t size = response.body.size();
  if (!without_body) message.body() = std::move(response.body);
  message.content_length(size);
  return message;
}

int status_of(error_code error) {
  if (error == http::error::body_limit) return 413;
  if (error == http::error::header_limit) return 431;
  return 400;
}

}  // namespace

class HttpServer::Impl {
 public:
  Impl(const HttpServerOptions& options, Handler handler)
      : options_(options), handler_(std::move(handler)), acceptor_(context_) {
    AccessRules& access = options_.access;
    if (!is_loopback(access.bind) && access.token.empty()) {
      throw InputError("--bind: found '" + access.bind + "' without a token, wanted --token or 127.0.0.1");
    }
    listen(access.bind == "localhost" ? "127.0.0.1" : access.bind);
    access.port = acceptor_.local_endpoint().port();
    asio::co_spawn(context_, accept(), asio::detached);
  }

  [[nodiscard]] unsigned short port() const { return options_.access.port; }
  void run_for(std::chrono::milliseconds time) { context_.run_for(time); }

 private:
  void listen(const std::string& address) {
    try {
      const tcp::endpoint endpoint(asio::ip::make_address(address), options_.access.port);
      acceptor_.open(endpoint.protocol());
      acceptor_.set_option(asio::socket_base::reuse_address(true));
      acceptor_.bind(endpoint);
      acceptor_.listen();
    } catch (const boost::system::system_error& error) {
      throw InputError(fmt::format("{} port {}: {}", address, options_.access.port, error.code().message()));
    }
  }

  asio::awaitable<void> accept() {
    for (;;) {
      error_code error;
      tcp::socket socket = co_await acceptor_.async_accept(asio::redirect_error(asio::use_awaitable, error));
      if (error) continue;
      if (connections_ >= options_.max_connections) continue;  // closes it
      asio::co_spawn(context_, serve(std::move(socket)), asio::detached);
    }
  }

  asio::awaitable<void> serve(tcp::socket socket) {
    ++connections_;
    beast::tcp_stream stream(std::move(socket));
    beast::flat_buffer buffer;
    while (co_await serve_one(stream, buffer)) {
    }
    error_code error;  // of a client that is gone already: no matter
    error = stream.socket().shutdown(tcp::socket::shutdown_both, error);
    --connections_;
  }

  /// One request and its answer. Is the connection kept?
  asio::awaitable<bool> serve_one(beast::tcp_stream& stream, beast::flat_buffer& buffer) {
    Parser parser;
    parser.header_limit(options_.max_header_bytes);
    parser.body_limit(options_.max_body_bytes);
    stream.expires_after(options_.patience);
    error_code error;
    co_await http::async_read_header(stream, buffer, parser,
                                     asio::redirect_error(asio::use_awaitable, error));
    if (error) co_return co_await complain(stream, error);

    HttpRequest request = head_of(parser);
    std::optional<HttpResponse> response = turned_away(request, options_.access);
    const bool keep = !response && parser.get().keep_alive();
    if (!response) {
      co_await http::async_read(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, error));
      if (error) co_return co_await complain(stream, error);
      request.body = std::move(parser.get().body());
      response = answer(request);
    }
    const bool sent = co_await send(stream, message_of(std::move(*response), keep, request.method == "HEAD"));
    co_return keep&& sent;
  }

  HttpResponse answer(const HttpRequest& request) const {
    try {
      if (request.target == "/api/session" && request.method == "POST") {
        return open_session(request, options_.access);
      }
      return handler_(request);
    } catch (const std::exception& error) {
      return refusal(500, error.what());
    }
  }

  /// For what is no request: says so, if the client still listens, and ends the connection.
  asio::awaitable<bool> complain(beast::tcp_stream& stream, error_code error) {
    const bool gone = error == http::error::end_of_stream || error == beast::error::timeout ||
                      error.category() == asio::error::get_system_category();
    if (gone) co_return false;
    co_await send(stream, message_of(refusal(status_of(error), error.message()), false, false));
    co_return false;
  }

  asio::awaitable<bool> send(beast::tcp_stream& stream, Message message) {
    stream.expires_after(options_.patience);
    error_code error;
    co_await http::async_write(stream, message, asio::redirect_error(asio::use_awaitable, error));
    co_return !error;
  }

  HttpServerOptions options_;
  Handler handler_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  int connections_ = 0;
};

HttpServer::HttpServer(const HttpServerOptions& options, Handler handler)
    : impl_(std::make_unique<Impl>(options, std::move(handler))) {}
HttpServer::~HttpServer() = default;

unsigned short HttpServer::port() const {
  return impl_->port();
}

void HttpServer::run_for(std::chrono::milliseconds time) {
  impl_->run_for(time);
}

}  // namespace lodestar
