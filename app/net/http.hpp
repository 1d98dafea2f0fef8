#pragma once

#include <stop_token>
#include <string>

// The parts of an HTTP request and response that the console uses.
namespace lodestar {

/// A client's role; each includes those before it.
enum class Role { view, edit, drive };
std::string_view to_string(Role role);

struct HttpRequest {
  std::string method;  ///< GET, PUT, ...
  std::string target;  ///< as sent: path and query
  std::string host;
  std::string origin;  ///< empty when the client sent none
  std::string content_type;
  std::string console_header;  ///< X-Lodestar: pages of other origins cannot send it unasked
  std::string client_name;     ///< X-Lodestar-Name, percent-encoded: what the client's user goes by
  std::string authorization;
  std::string cookie;
  std::string if_match;
  std::string if_none_match;
  bool wants_socket = false;  ///< requests an upgrade to a WebSocket
  std::string subprotocols;   ///< offered for it, separated by commas
  std::string body;
  std::stop_token cancelled;  ///< of a request that takes long: nobody waits for the response any more
};

struct HttpResponse {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::string etag;        ///< with its quotation marks; empty for none
  std::string set_cookie;  ///< empty for none
};

/// An error response: {"error": words}.
HttpResponse refusal(int status, const std::string& words);

}  // namespace lodestar
