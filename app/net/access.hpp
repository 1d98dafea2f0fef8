#pragma once

#include <optional>

#include "app/net/http.hpp"

// Who may talk to the console. Any web page can send requests to 127.0.0.1 and open sockets there, so being
// reached over loopback proves nothing.
namespace lodestar {

struct AccessRules {
  std::string bind = "127.0.0.1";
  unsigned short port = 0;
  // Who has a token may do what it is for. With none of them set everyone may do everything, which only
  // loopback allows.
  std::string token;  ///< to drive, and all else
  std::string edit_token;
  std::string view_token;

  [[nodiscard]] bool asks_for_token() const;
};

/// What the client may do, by the token it sends as `Authorization: Bearer` or as the cookie; nothing without
/// a valid one.
std::optional<Role> role_of(const HttpRequest& head, const AccessRules& rules);

bool is_loopback(const std::string& address);

/// Are they the same? Takes as long for a wrong first byte as for a wrong last one.
bool equal_in_constant_time(const std::string& a, const std::string& b);

/// The answer that turns a request away, or nothing when it may go on. Looks at the head only, so it can be
/// asked before a body is read:
/// - Host must be an address or localhost with our port: a foreign name that resolves to us (DNS rebinding)
/// is
///   refused;
/// - Origin, where sent, must be ourselves;
/// - what changes something must carry X-Lodestar and be JSON: no form of another page can do that unasked;
/// - where tokens are asked for, all of /api/ but the session itself and every WebSocket needs one;
/// - PUT needs the one to edit.
std::optional<HttpResponse> turned_away(const HttpRequest& head, const AccessRules& rules);

/// GET: what the client may do. POST, of a page that offers a token: the cookie. 401 without a valid one.
HttpResponse answer_session(const HttpRequest& request, const AccessRules& rules);

}  // namespace lodestar
