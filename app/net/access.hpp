#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/net/http.hpp"

// Access control of the console. Any web page can send requests to 127.0.0.1 and open sockets there, so a
// request over loopback is not trusted.
namespace lodestar {

struct AccessRules {
  std::string bind = "127.0.0.1";
  unsigned short port = 0;
  /// By which browsers may call this machine, besides localhost and its addresses; in lower case.
  std::vector<std::string> host_names;
  // Each token grants its role. With none of them set every client may do everything, which is allowed on
  // loopback only.
  std::string token;  ///< for the role drive, which includes the others
  std::string edit_token;
  std::string view_token;

  [[nodiscard]] bool asks_for_token() const;
};

/// The client's role, by the token it sends as `Authorization: Bearer` or as the cookie; nothing without a
/// valid one.
std::optional<Role> role_of(const HttpRequest& head, const AccessRules& rules);

bool is_loopback(const std::string& address);

/// Are they equal? Takes as long for a wrong first byte as for a wrong last one.
bool equal_in_constant_time(const std::string& a, const std::string& b);

/// The response that refuses a request, or nothing when it may proceed. Reads the header only, so it can be
/// called before the body is read:
/// - Host must be an address, localhost or one of the host names with our port: another name that resolves
///   to us (DNS rebinding) is refused;
/// - Origin, where sent, must be ourselves;
/// - a request that changes something must carry X-Lodestar and be JSON: a form of another page cannot;
/// - with tokens configured, all of /api/ but the session itself and every WebSocket need one;
/// - PUT needs the role edit.
std::optional<HttpResponse> rejection(const HttpRequest& head, const AccessRules& rules);

/// GET: the client's role. POST with a token: sets the cookie. 401 without a valid token.
HttpResponse answer_session(const HttpRequest& request, const AccessRules& rules);

}  // namespace lodestar
