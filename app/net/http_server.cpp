#include "app/net/http_server.hpp"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <fmt/format.h>

#include "app/common/worker.hpp"
#include "app/net/beast_http.hpp"
#include "app/net/waiting_connections.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// One client of a subprotocol, shared by the two coroutines that read from it and write to it.
struct SocketClient {
  SocketClient(beast::tcp_stream connected, const OutboxLimits& limits)
      : stream(std::move(connected)), outbox(limits), wake(stream.get_executor()) {}

  void notify() { wake.cancel(); }
  void leave() {
    gone = true;
    wake.cancel();
    beast::get_lowest_layer(stream).close();
  }

  websocket::stream<beast::tcp_stream> stream;
  Outbox outbox;
  asio::steady_timer wake;
  std::unique_ptr<SocketSession> session;  // refers to the outbox, so it is destroyed first
  bool gone = false;
};

/// Sends what comes into the outbox, one message after the other.
asio::awaitable<void> write_all(std::shared_ptr<SocketClient> client) {
  error_code error;
  while (!client->gone) {
    if (const std::optional<SocketMessage> message = client->outbox.take()) {
      client->stream.binary(message->binary);
      co_await client->stream.async_write(asio::buffer(*message->bytes),
                                          asio::redirect_error(asio::use_awaitable, error));
      if (error) client->leave();
    } else {
      client->wake.expires_at(asio::steady_timer::time_point::max());
      co_await client->wake.async_wait(asio::redirect_error(asio::use_awaitable, error));
    }
  }
}

/// Passes the client's messages to the session, until either side ends.
asio::awaitable<void> read_all(std::shared_ptr<SocketClient> client) {
  error_code error;
  beast::flat_buffer buffer;
  while (!client->gone) {
    co_await client->stream.async_read(buffer, asio::redirect_error(asio::use_awaitable, error));
    if (error) break;
    try {
      client->session->receive(beast::buffers_to_string(buffer.data()), client->stream.got_binary());
    } catch (const std::exception&) {
      break;  // the message does not follow the subprotocol
    }
    buffer.consume(buffer.size());
  }
}

/// Counts one more for as long as it lives, whatever ends the coroutine that it stands in.
class Counted {
 public:
  explicit Counted(int& count) : count_(count) { ++count_; }
  ~Counted() { --count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  int& count_;
};

/// A response that the worker makes and a coroutine of the server waits for.
struct LongAnswer {
  explicit LongAnswer(const asio::any_io_executor& executor) : done(executor) {}

  HttpResponse response;
  bool is_done = false;  ///< known to the server's thread alone, which the worker tells by post
  asio::steady_timer done;
};

/// Has the client closed its end? Asked of a socket that is readable; a client that has sent its next request
/// already is still there.
bool has_left(tcp::socket& socket) {
  error_code error;
  char next = 0;
  return socket.receive(asio::buffer(&next, 1), tcp::socket::message_peek, error) == 0 || error.failed();
}

/// Cancels the work when the client leaves before it is done.
void cancel_when_left(tcp::socket& socket, const std::shared_ptr<LongAnswer>& answer,
                      std::stop_source cancel) {
  socket.async_wait(tcp::socket::wait_read, [&socket, answer, cancel](error_code error) mutable {
    if (answer->is_done) return;  // and the socket may be gone
    if (error || has_left(socket)) cancel.request_stop();
  });
}

}  // namespace

class HttpServer::Impl {
 public:
  Impl(const HttpServerOptions& options, Handler handler, std::vector<SocketProtocol> protocols)
      : options_(options),
        handler_(std::move(handler)),
        protocols_(std::move(protocols)),
        acceptor_(context_),
        drafts_(options.most_waiting),
        files_(static_cast<std::size_t>(options.max_connections)) {
    AccessRules& access = options_.access;
    if (!is_loopback(access.bind) && !access.asks_for_token()) {
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
      // Who connects and says nothing shuts nobody out.
      if (connections_ >= options_.max_connections && !waiting_.end_longest()) continue;  // closes it
      asio::co_spawn(context_, serve(std::move(socket)), asio::detached);
    }
  }

  asio::awaitable<void> serve(tcp::socket socket) {
    const Counted counted(connections_);
    beast::tcp_stream stream(std::move(socket));
    beast::flat_buffer buffer;
    Next next = Next::another_request;
    while (next == Next::another_request) next = co_await serve_one(stream, buffer);
    if (next == Next::upgraded) co_return;
    error_code error;  // ignored: the client may be gone already
    error = stream.socket().shutdown(tcp::socket::shutdown_both, error);
  }

  enum class Next { another_request, end, upgraded };  ///< upgraded: to a WebSocket, the stream is moved from

  /// One request and its response.
  asio::awaitable<Next> serve_one(beast::tcp_stream& stream, beast::flat_buffer& buffer) {
    Parser parser;
    parser.header_limit(options_.max_header_bytes);
    parser.body_limit(options_.max_body_bytes);
    stream.expires_after(options_.patience);
    error_code error;
    std::optional<WaitingConnections::Entry> waiting(std::in_place, waiting_, stream);
    co_await http::async_read_header(stream, buffer, parser,
                                     asio::redirect_error(asio::use_awaitable, error));
    if (error) co_return co_await complain(stream, error);

    HttpRequest request = head_of(parser);
    std::optional<HttpResponse> response = rejection(request, options_.access);
    const bool takes_long = !request.wants_socket && options_.takes_long && options_.takes_long(request);
    const bool uses_files = !takes_long && options_.uses_files && options_.uses_files(request);
    if (!response && takes_long && role_of(request, options_.access) < Role::edit) {
      response = refusal(403, "found a token to view, wanted one to edit");
    }
    if (!response && request.wants_socket) {
      response = no_socket(request);
      if (!response) {
        waiting.reset();
        asio::co_spawn(context_, serve_socket(std::move(stream), parser.release(), request), asio::detached);
        co_return Next::upgraded;
      }
    }
    const bool keep = !response && parser.get().keep_alive();
    const bool without_body = request.method == "HEAD";
    if (!response) {
      co_await http::async_read(stream, buffer, parser, asio::redirect_error(asio::use_awaitable, error));
      if (error) co_return co_await complain(stream, error);
      waiting.reset();
      request.body = std::move(parser.get().body());
      if (takes_long || uses_files) {
        Worker& worker = takes_long ? drafts_ : files_;
        response = co_await long_answer(worker, stream.socket(), std::move(request));
      } else {
        response = answer(request);
      }
    }
    const bool sent = co_await send(stream, message_of(std::move(*response), keep, without_body));
    co_return keep&& sent ? Next::another_request : Next::end;
  }

  /// The refusal of a WebSocket, if it must be refused.
  [[nodiscard]] std::optional<HttpResponse> no_socket(const HttpRequest& request) const {
    if (chosen_protocol(protocols_, request.subprotocols) == nullptr) {
      return refusal(400, "found no subprotocol of ours in Sec-WebSocket-Protocol");
    }
    const bool drives = role_of(request, options_.access) == Role::drive;
    const int most = drives ? options_.max_sockets : 3 * options_.max_sockets / 4;
    if (sockets_ >= most) return refusal(503, "found too many clients, try again later");
    return std::nullopt;
  }

  /// Serves a WebSocket from its upgrade until the client disconnects, or neither reads nor answers pings any
  /// more.
  asio::awaitable<void> serve_socket(beast::tcp_stream stream, Parser::value_type upgrade, HttpRequest head) {
    const SocketProtocol& protocol = *chosen_protocol(protocols_, head.subprotocols);
    stream.expires_never();  // the WebSocket has timers of its own
    const auto client = std::make_shared<SocketClient>(std::move(stream), options_.outbox);
    client->stream.set_option(websocket::stream_base::timeout{
        .handshake_timeout = options_.patience, .idle_timeout = options_.patience, .keep_alive_pings = true});
    client->stream.set_option(
        websocket::stream_base::decorator([name = protocol.name](websocket::response_type& response) {
          if (!name.empty()) response.set(http::field::sec_websocket_protocol, name);
        }));
    client->stream.read_message_max(options_.max_socket_message_bytes);
    client->stream.auto_fragment(false);  // one write per message
    error_code error;
    co_await client->stream.async_accept(upgrade, asio::redirect_error(asio::use_awaitable, error));
    if (error) co_return;
    const Counted counted(sockets_);
    client->outbox.on_work([raw = client.get()] { raw->outbox.overflowed() ? raw->leave() : raw->notify(); });
    client->session = protocol.open(*role_of(head, options_.access), client->outbox);
    asio::co_spawn(context_, write_all(client), asio::detached);
    co_await read_all(client);
    client->session.reset();
    client->leave();
  }

  [[nodiscard]] HttpResponse answer(const HttpRequest& request) const {
    try {
      if (request.target == "/api/session") return answer_session(request, options_.access);
      return handler_(request);
    } catch (const std::exception& error) {
      return refusal(500, error.what());
    } catch (...) {
      return refusal(500, "an error without words");
    }
  }

  /// The worker's answer. Clients after this one are served meanwhile, this one's next requests are not.
  asio::awaitable<HttpResponse> long_answer(Worker& worker, tcp::socket& socket, HttpRequest request) {
    const auto answered = std::make_shared<LongAnswer>(context_.get_executor());
    const std::optional<std::stop_source> cancel =
        worker.give([this, answered, request = std::move(request)](const std::stop_token& cancelled) mutable {
          request.cancelled = cancelled;
          if (!cancelled.stop_requested()) answered->response = answer(request);
          asio::post(context_, [answered] {
            answered->is_done = true;
            answered->done.cancel();
          });
        });
    if (!cancel) co_return refusal(503, "found too much work of others waiting, try again later");
    cancel_when_left(socket, answered, *cancel);
    error_code error;
    while (!answered->is_done) {
      answered->done.expires_at(asio::steady_timer::time_point::max());
      co_await answered->done.async_wait(asio::redirect_error(asio::use_awaitable, error));
    }
    [[maybe_unused]] const error_code gone = socket.cancel(error);
    co_return std::move(answered->response);
  }

  /// Answers a malformed request with an error, if the client is still connected, and ends the connection.
  asio::awaitable<Next> complain(beast::tcp_stream& stream, error_code error) {
    const bool gone = error == http::error::end_of_stream || error == beast::error::timeout ||
                      error.category() == asio::error::get_system_category();
    if (!gone) {
      co_await send(stream, message_of(refusal(status_of(error), error.message()), false, false));
    }
    co_return Next::end;
  }

  asio::awaitable<bool> send(beast::tcp_stream& stream, Message message) {
    stream.expires_after(options_.patience);
    error_code error;
    co_await http::async_write(stream, message, asio::redirect_error(asio::use_awaitable, error));
    co_return !error;
  }

  HttpServerOptions options_;
  Handler handler_;
  std::vector<SocketProtocol> protocols_;
  // What coroutines count themselves in: they end with the context.
  int connections_ = 0;
  int sockets_ = 0;
  WaitingConnections waiting_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  Worker drafts_;  // both end before the context that they post to
  Worker files_;
};

HttpServer::HttpServer(const HttpServerOptions& options, Handler handler,
                       std::vector<SocketProtocol> protocols)
    : impl_(std::make_unique<Impl>(options, std::move(handler), std::move(protocols))) {}
HttpServer::~HttpServer() = default;

unsigned short HttpServer::port() const {
  return impl_->port();
}

void HttpServer::run_for(std::chrono::milliseconds time) {
  impl_->run_for(time);
}

}  // namespace lodestar
