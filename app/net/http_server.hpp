#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <utility>  // the coroutines of Boost 1.74 use std::exchange without including it

#include "app/net/access.hpp"
#include "app/net/socket.hpp"

namespace lodestar {

struct HttpServerOptions {
  AccessRules access;  ///< port 0: any free port
  std::size_t max_body_bytes = 4U << 20U;
  unsigned max_header_bytes = 16U << 10U;
  int max_connections = 32;  ///< the one that has sent nothing for longest makes room for another
  int max_sockets = 128;     ///< three quarters of them for those who may not drive, who shut no driver out
  std::size_t max_socket_message_bytes = 64U << 10U;  ///< received over a WebSocket
  OutboxLimits outbox;
  std::chrono::seconds patience{15};  ///< timeout for a client that neither sends nor reads
  /// Which requests take long, by their header. They need the role edit, and a thread of their own handles
  /// them one after the other, so that a stop over a WebSocket never waits for them.
  std::function<bool(const HttpRequest& head)> takes_long;
  /// Requests that take long, beside the one under way; 503 beyond that. A page that is opened makes three.
  std::size_t most_waiting = 16;
  /// Which read or write files, by their header: another thread handles these, for all roles, so that neither
  /// the sockets nor who only looks wait for a disk or for another client's draft.
  std::function<bool(const HttpRequest& head)> uses_files;
};

/// An HTTP/1.1 and WebSocket server on one thread, the caller's. It enforces the access rules and the limits
/// before the handler or a session sees anything; a handler that throws gives 500 with its message. A
/// WebSocket request, on any target, gets the subprotocol that it offers. Boost.Beast stays in the .cpp.
/// The handlers of requests that take long and of those that use files run beside the server's thread, at
/// most one of each kind at a time: they may share only what does not change, and should end early when the
/// request is cancelled, as it is when its client has left.
class HttpServer {
 public:
  using Handler = std::function<HttpResponse(const HttpRequest&)>;

  /// Listens at once. Throws InputError when the address or the port cannot be bound, and for an address
  /// other than loopback without a token. Sessions of `protocols` end with the server at the latest.
  HttpServer(const HttpServerOptions& options, Handler handler, std::vector<SocketProtocol> protocols = {});
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] unsigned short port() const;

  /// Serves all clients for this time.
  void run_for(std::chrono::milliseconds time);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lodestar
