#pragma once

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <string>
#include <utility>

#include "app/net/http.hpp"

// Requests and responses as Boost.Beast has them. For http_server.cpp alone: Beast takes long to compile.
namespace lodestar {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using beast::error_code;

using Parser = http::request_parser<http::string_body>;
using Message = http::response<http::string_body>;

inline std::string text(beast::string_view view) {
  return {view.data(), view.size()};
}

inline HttpRequest head_of(const Parser& parser) {
  const auto& fields = parser.get();
  return {.method = text(fields.method_string()),
          .target = text(fields.target()),
          .host = text(fields[http::field::host]),
          .origin = text(fields[http::field::origin]),
          .content_type = text(fields[http::field::content_type]),
          .console_header = text(fields["X-Lodestar"]),
          .client_name = text(fields["X-Lodestar-Name"]),
          .authorization = text(fields[http::field::authorization]),
          .cookie = text(fields[http::field::cookie]),
          .if_match = text(fields[http::field::if_match]),
          .if_none_match = text(fields[http::field::if_none_match]),
          .wants_socket = websocket::is_upgrade(fields),
          .subprotocols = text(fields[http::field::sec_websocket_protocol]),
          .body = {}};
}

/// Security headers: nothing from other origins, no script but our own file, no framing, whatever text a
/// document holds.
inline void add_safety(Message& message) {
  message.set("Content-Security-Policy",
              "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
              "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  message.set("X-Content-Type-Options", "nosniff");
  message.set("X-Frame-Options", "DENY");
  message.set("Referrer-Policy", "no-referrer");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
  message.set(http::field::cache_control, "no-cache");
}

inline Message message_of(HttpResponse response, bool keep_alive, bool without_body) {
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

inline int status_of(error_code error) {
  if (error == http::error::body_limit) return 413;
  if (error == http::error::header_limit) return 431;
  return 400;
}

}  // namespace lodestar
