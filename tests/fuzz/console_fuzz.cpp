#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "app/console/document_api.hpp"
#include "app/net/access.hpp"
#include "maps/input_error.hpp"

#include "tests/fuzz/scratch_file.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// A fresh copy of the lab's site, which requests may change.
fs::path fresh_site() {
  const fs::path folder = scratch_file("none", nullptr, 0).parent_path() / "site";
  fs::remove_all(folder);
  fs::copy(fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", folder, fs::copy_options::recursive);
  return folder;
}

/// "METHOD TARGET", lines of "name: value", an empty line, the body. An If-Match of "now" means the current
/// version.
HttpRequest request_from(const std::string& text) {
  std::istringstream stream(text);
  HttpRequest request;
  std::string line;
  std::getline(stream, line);
  const std::size_t space = line.find(' ');
  request.method = line.substr(0, space);
  if (space != std::string::npos) request.target = line.substr(space + 1);
  while (std::getline(stream, line) && !line.empty()) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    const std::string name = line.substr(0, colon);
    const std::string value = line.substr(colon + 2);
    if (name == "Host") request.host = value;
    if (name == "Origin") request.origin = value;
    if (name == "Content-Type") request.content_type = value;
    if (name == "X-Lodestar") request.console_header = value;
    if (name == "Authorization") request.authorization = value;
    if (name == "Cookie") request.cookie = value;
    if (name == "If-Match") request.if_match = value;
    if (name == "If-None-Match") request.if_none_match = value;
  }
  std::ostringstream body;
  body << stream.rdbuf();
  request.body = body.str();
  return request;
}

void expect_sound(const HttpResponse& response) {
  if (response.status < 200 || response.status > 599) __builtin_trap();
  if (response.content_type == "application/json" && !response.body.empty() &&
      !nlohmann::json::accept(response.body)) {
    __builtin_trap();
  }
}

/// A console with a site of its own.
struct Desk {
  fs::path site = fresh_site();
  DocumentApi console{site, site / "runs"};
};

void ask(const std::string& text) {
  static std::optional<Desk> desk;
  if (!desk) desk.emplace();
  HttpRequest request = request_from(text);
  const AccessRules rules{.port = 8080, .token = "secret"};
  if (const std::optional<HttpResponse> refused = rejection(request, rules)) expect_sound(*refused);
  expect_sound(answer_session(request, rules));
  if (request.if_match == "now")
    request.if_match = desk->console.answer({.method = "GET", .target = "/api/markers"}).etag;
  expect_sound(desk->console.answer(request));
  if (request.method != "PUT") return;
  (void)load_registry(desk->site / "markers.yaml");  // a saved registry can be loaded
  desk.reset();
}

}  // namespace
}  // namespace lodestar

// Whatever a client sends, the response is valid, and what it saves can be read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lodestar::ask(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
