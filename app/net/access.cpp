#include "app/net/access.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/json_parse.hpp"
#include "app/common/json_text.hpp"

namespace lodestar {
namespace {

constexpr const char* cookie_name = "lodestar";

/// An IPv4 address, or an IPv6 address in brackets: not a name that a foreign DNS server could resolve.
bool is_address(const std::string& host) {
  if (host.starts_with('[') && host.ends_with(']')) {
    return host.find_first_not_of("0123456789abcdefABCDEF:.", 1) == host.size() - 1;
  }
  return !host.empty() && host.find_first_not_of("0123456789.") == std::string::npos;
}

std::string in_lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

bool is_our_host(const std::string& host, const AccessRules& rules) {
  const std::string suffix = fmt::format(":{}", rules.port);
  if (!host.ends_with(suffix)) return false;
  const std::string name = in_lower_case(host.substr(0, host.size() - suffix.size()));
  return name == "localhost" || is_address(name) ||
         std::ranges::find(rules.host_names, name) != rules.host_names.end();
}

/// Our cookie among those that other ports of the same host have set.
std::string token_in(const std::string& cookies) {
  const std::string key = std::string(cookie_name) + "=";
  std::size_t at = 0;
  while (at < cookies.size()) {
    const std::size_t end = std::min(cookies.find(';', at), cookies.size());
    const std::size_t start = std::min(cookies.find_first_not_of(' ', at), end);
    if (cookies.compare(start, key.size(), key) == 0) {
      return cookies.substr(start + key.size(), end - start - key.size());
    }
    at = end + 1;
  }
  return "";
}

/// Compares with all tokens even after a match, so that timing reveals nothing.
std::optional<Role> role_for(const std::string& offered, const AccessRules& rules) {
  if (!rules.asks_for_token()) return Role::drive;
  std::optional<Role> role;
  const auto compare = [&](const std::string& token, Role its) {
    if (equal_in_constant_time(offered, token) && !token.empty()) role = its;
  };
  compare(rules.view_token, Role::view);
  compare(rules.edit_token, Role::edit);
  compare(rules.token, Role::drive);
  return role;
}

/// Of {"token": "..."}; empty for all else.
std::string offered_token(const std::string& body) {
  try {
    return parse_json(body).at("token").get<std::string>();
  } catch (const std::exception&) {
    return "";
  }
}

HttpResponse session_of(Role role) {
  return {.body = json_text(nlohmann::json{{"role", to_string(role)}})};
}

}  // namespace

std::string_view to_string(Role role) {
  switch (role) {
    case Role::view:
      return "view";
    case Role::edit:
      return "edit";
    case Role::drive:
      break;
  }
  return "drive";
}

HttpResponse refusal(int status, const std::string& words) {
  using nlohmann::json;
  return {.status = status, .body = json_text(json{{"error", words}})};
}

bool AccessRules::asks_for_token() const {
  return !token.empty() || !edit_token.empty() || !view_token.empty();
}

std::optional<Role> role_of(const HttpRequest& head, const AccessRules& rules) {
  constexpr std::string_view bearer = "Bearer ";
  return role_for(head.authorization.starts_with(bearer) ? head.authorization.substr(bearer.size())
                                                         : token_in(head.cookie),
                  rules);
}

bool is_loopback(const std::string& address) {
  return address == "localhost" || address == "::1" || (address.starts_with("127.") && is_address(address));
}

bool equal_in_constant_time(const std::string& a, const std::string& b) {
  std::size_t different = a.size() ^ b.size();
  for (std::size_t i = 0; i < b.size(); ++i) {
    const char mine = i < a.size() ? a[i] : '\0';
    different |= static_cast<unsigned char>(mine ^ b[i]);
  }
  return different == 0;
}

std::optional<HttpResponse> rejection(const HttpRequest& head, const AccessRules& rules) {
  if (!is_our_host(head.host, rules)) {
    return refusal(403,
                   "found the host '" + head.host + "', wanted an address or --host-name, and this port");
  }
  if (!head.origin.empty() && head.origin != "http://" + head.host) {
    return refusal(403, "found a request of another page, wanted one of the console's own");
  }
  const bool changes = head.method != "GET" && head.method != "HEAD";
  if (changes && head.console_header.empty()) return refusal(403, "found no X-Lodestar header, wanted one");
  if (changes && !head.content_type.starts_with("application/json")) {
    return refusal(415, "found '" + head.content_type + "', wanted application/json");
  }
  const bool is_guarded =
      head.wants_socket || (head.target.starts_with("/api") && head.target != "/api/session");
  const std::optional<Role> role = role_of(head, rules);
  if (is_guarded && !role) return refusal(401, "found no valid token, wanted it");
  if (head.method == "PUT" && role < Role::edit)
    return refusal(403, "found a token to view, wanted one to edit");
  return std::nullopt;
}

HttpResponse answer_session(const HttpRequest& request, const AccessRules& rules) {
  if (request.method != "POST") {
    const std::optional<Role> role = role_of(request, rules);
    return role ? session_of(*role) : refusal(401, "found no valid token, wanted it");
  }
  const std::string offered = offered_token(request.body);
  const std::optional<Role> role = role_for(offered, rules);
  if (!role) return refusal(401, "found another token");
  HttpResponse response = session_of(*role);
  if (rules.asks_for_token()) {
    response.set_cookie = fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_name, offered);
  }
  return response;
}

}  // namespace lodestar
