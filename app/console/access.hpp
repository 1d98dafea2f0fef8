#pragma once

#include <optional>

#include "app/console/http.hpp"

// Who may talk to the console. Any web page can send requests to 127.0.0.1 and open sockets there, so being
// reached over loopback proves nothing.
namespace lodestar {

struct AccessRules {
  std::string bind = "127.0.0.1";
  unsigned short port = 0;
  std::string token;  ///< empty: none is asked for, which only loopback allows
};

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
/// - with a token, all of /api/ but the session itself needs it, as `Authorization: Bearer` or as the cookie.
std::optional<HttpResponse> turned_away(const HttpRequest& head, const AccessRules& rules);

/// The answer to a page that offers the token: the cookie, or 401.
HttpResponse open_session(const HttpRequest& request, const AccessRules& rules);

}  // namespace lodestar
