#include "app/console/places_api.hpp"

#include <charconv>
#include <utility>

#include "app/common/json_text.hpp"
#include "app/console/etag.hpp"
#include "app/console/history_json.hpp"
#include "app/console/places_json.hpp"
#include "app/console/routes.hpp"
#include "app/placement/places_check.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using nlohmann::ordered_json;

constexpr const char* places_path = "/api/places";
constexpr const char* routes_path = "/api/routes";
constexpr const char* places_history_path = "/api/places/history";

HttpResponse tagged_document(const ordered_json& content, const std::string& etag) {
  return {.body = json_text(content), .etag = etag};
}

HttpResponse refused(const PlacesRefusal& why) {
  return {.status = 422, .body = json_text(refusal_json(why))};
}

std::variant<Places, PlacesRefusal> sent_places(const HttpRequest& request, const Places& before,
                                                const Robot& robot) {
  if (request.target != routes_path) return places_from_json(request.body, robot);
  try {
    return with_routes(before, request.body);
  } catch (const InputError& error) {
    return PlacesRefusal{error.what(), "", 0};
  }
}

/// With it the site could not be loaded again.
std::optional<PlacesRefusal> site_refuses(const Places& places, const Site& site) {
  if (const std::optional<std::string> action = unknown_action(places, site))
    return PlacesRefusal{"found " + *action + ", wanted one of the actions of site.yaml", "", 0};
  if (!site.charging || charging_at(site.charging, places)) return std::nullopt;
  return PlacesRefusal{
      "found no place '" + site.charging->place + "' with a heading, wanted it: the robot charges there", "",
      0};
}

}  // namespace

PlacesApi::PlacesApi(const Site& site, const CoveredFloor& floor, AuditLog& audit)
    : site_(site), floor_(floor), audit_(audit), history_(site.folder / ".history" / "places") {}

std::optional<HttpResponse> PlacesApi::answer(const HttpRequest& request) const {
  const std::string& target = request.target;
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (reads && target == places_path) return places();
  if (reads && target == routes_path) return routes();
  if (reads && target.starts_with(places_history_path))
    return history(target.substr(std::string(places_history_path).size()));
  if (request.method == "PUT" && (target == places_path || target == routes_path))
    return save(request, load_places(site_.folder));
  if (request.method == "POST" && target == "/api/places/check") return check(request);
  return std::nullopt;
}

HttpResponse PlacesApi::places() const {
  const Places places = load_places(site_.folder);
  return tagged_document(places_json(places), etag_of(places_text(places)));
}

HttpResponse PlacesApi::routes() const {
  const Places places = load_places(site_.folder);
  return tagged_document(routes_json(places), etag_of(places_text(places)));
}

HttpResponse PlacesApi::save(const HttpRequest& request, const Places& before) const {
  const std::string text_before = places_text(before);
  if (std::optional<HttpResponse> conflict = conflict_with(text_before, request.if_match)) return *conflict;
  const auto sent = sent_places(request, before, site_.robot);
  if (const auto* why = std::get_if<PlacesRefusal>(&sent)) return refused(*why);
  const Places& after = std::get<Places>(sent);
  if (const auto why = site_refuses(after, site_)) return refused(*why);
  if (places_text(after) != text_before) {
    const int state = history_.keep(text_before);
    save_places(after, site_.folder);
    audit_.note(
        {.by = name_of(request), .what = "saved places and zones", .document = "places", .state = state});
    if (on_saved_) on_saved_(after);
  }
  return request.target == routes_path ? routes() : places();
}

/// On a copy of the site: the running robot and other clients go by what is saved.
HttpResponse PlacesApi::check(const HttpRequest& request) const {
  auto sent = places_from_json(request.body, site_.robot);
  if (const auto* why = std::get_if<PlacesRefusal>(&sent)) return refused(*why);
  if (const auto why = site_refuses(std::get<Places>(sent), site_)) return refused(*why);
  Site draft = site_;
  draft.places = std::move(std::get<Places>(sent));
  draft.registry = load_registry(site_.registry_file);  // as it is saved now
  ordered_json issues = ordered_json::array();
  for (const PlacesIssue& issue : check_places(draft, &floor_)) issues.push_back(issue_json(issue));
  return {.body = json_text(issues)};
}

HttpResponse PlacesApi::history(const std::string& rest) const {
  if (rest.empty()) return tagged_document(history_json(history_, audit_, "places"), "");
  int number = 0;
  const char* const end = rest.data() + rest.size();
  const auto [stop, error] = std::from_chars(rest.data() + 1, end, number);
  const bool is_number = rest.front() == '/' && error == std::errc() && stop == end;
  const std::optional<std::string> text = is_number ? history_.text(number) : std::nullopt;
  if (!text) return refusal(404, "found no such state");
  return tagged_document(places_json(parse_places(*text, "history")), etag_of(*text));
}

}  // namespace lodestar
