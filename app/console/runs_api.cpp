#include "app/console/runs_api.hpp"

#include "app/common/percent_decoding.hpp"
#include "app/console/etag.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::string_view runs_path = "/api/runs";

HttpResponse bytes(const std::optional<std::string>& body, const char* type) {
  if (!body) return refusal(404, "found no such document");
  return with_etag({.content_type = type, .body = *body});
}

}  // namespace

std::optional<HttpResponse> RunsApi::answer(const HttpRequest& request) const {
  if (request.method != "GET" && request.method != "HEAD") return std::nullopt;
  std::string_view rest = request.target;
  try {
    if (rest == "/api/heat") return json_document(runs_.heat(site_));
    if (!rest.starts_with(runs_path)) return std::nullopt;
    rest.remove_prefix(runs_path.size());
    if (rest.empty()) return json_document(runs_.list());
    if (rest.front() != '/') return std::nullopt;
    return one(rest.substr(1));
  } catch (const InputError& error) {
    return refusal(422, error.what());
  } catch (const json::exception& error) {
    return refusal(422, error.what());
  }
}

HttpResponse RunsApi::one(std::string_view rest) const {
  constexpr std::string_view cells_ending = "/cells";
  constexpr std::string_view pictures = "/pictures/";
  const std::size_t picture = rest.find(pictures);
  const bool is_cells = rest.ends_with(cells_ending);
  const std::size_t end = is_cells ? rest.size() - cells_ending.size() : picture;
  const std::optional<std::string> name = percent_decoded(rest.substr(0, end));
  if (!name) return refusal(404, "found no such run");
  if (is_cells) return bytes(runs_.cells(*name), "application/octet-stream");
  if (picture != std::string_view::npos)
    return bytes(runs_.picture(*name, std::string(rest.substr(picture + pictures.size()))), "image/jpeg");
  const std::optional<ordered_json> run = runs_.run(*name);
  return run ? json_document(*run) : refusal(404, "found no such run");
}

}  // namespace lodestar
