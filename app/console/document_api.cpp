#include "app/console/document_api.hpp"

#include <charconv>
#include <fmt/format.h>
#include <utility>

#include "app/common/json_parse.hpp"
#include "app/common/json_text.hpp"
#include "app/common/wall_clock.hpp"
#include "app/common/whole_number.hpp"
#include "app/console/etag.hpp"
#include "app/console/history_json.hpp"
#include "app/console/map_json.hpp"
#include "app/console/page_file.hpp"
#include "app/console/registry_edit.hpp"
#include "app/console/registry_json.hpp"
#include "app/placement/formats.hpp"
#include "app/placement/installation.hpp"
#include "app/placement/place_sheet.hpp"
#include "maps/atomic_file.hpp"
#include "maps/file_text.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* history_path = "/api/markers/history";

ordered_json robot_json(const Robot& robot) {
  ordered_json outline;  // null for a disc
  if (robot.footprint) {
    for (const Vec2& corner : robot.footprint->corners_m()) outline.push_back({corner.x(), corner.y()});
  }
  return {{"name", robot.name}, {"radius_m", robot.radius_m}, {"footprint_m", outline}};
}

ordered_json heights_json(const std::optional<HeightBands>& heights) {
  if (!heights) return nullptr;
  return {{"low_m", heights->low_m}, {"step_m", heights->step_m}, {"touch_m", heights->touch_m}};
}

/// 304 for a document that the client has.
HttpResponse unless_known(const HttpResponse& response, const HttpRequest& request) {
  if (response.etag.empty() || !has_etag(request.if_none_match, response.etag)) return response;
  return {.status = 304, .etag = response.etag};
}

HttpResponse exported(const json& request) {
  const auto format = marker_format_named(request.at("format").get<std::string>());
  if (!format) return refusal(422, "found an unknown format, wanted one of the formats of /api/site");
  const MarkerRegistry registry = registry_from_json(json_text(request.at("registry")));
  return {.body = json_text(json{{"text", markers_text(registry, *format)}})};
}

HttpResponse imported(const json& request) {
  const auto name = request.at("name").get<std::string>();
  const auto text = request.at("text").get<std::string>();
  const auto format = guess_marker_format(name, text);
  if (!format) return refusal(422, "found a file name that does not tell the format");
  return {.body = json_text(registry_json(parse_markers(text, *format, name)))};
}

std::string today() {
  return utc_text().substr(0, std::string_view("2026-11-26").size());
}

/// Sheets of IDs; with a registry, of where its markers hang.
HttpResponse printed(const json& request, const Site& site) {
  constexpr std::size_t most_sheets = marker_id_count;
  const json& ids = request.at("ids");
  const auto paper = paper_named(request.value("paper", "A4"));
  if (!paper || !ids.is_array() || ids.empty() || ids.size() > most_sheets) {
    return refusal(422, fmt::format("wanted A4 or A3 and 1 to {} IDs", most_sheets));
  }
  std::optional<MarkerRegistry> registry;
  std::optional<PlaceSheets> places;
  if (request.contains("registry")) {
    registry = registry_from_json(json_text(request["registry"]));
    places.emplace(site.map.map, site.name, today(), *paper);
  }
  std::vector<SheetPage> pages;
  for (const json& written : ids) {
    const int id = static_cast<int>(whole_number(written, marker_id_count - 1));
    const RegisteredMarker* const marker = registry ? registry->find(id) : nullptr;
    if (registry && marker == nullptr)
      return refusal(422, fmt::format("found no marker {} in the registry", id));
    pages.push_back(marker != nullptr ? places->page(*registry, *marker) : draw_marker_sheet(id, *paper));
  }
  return {.content_type = "application/pdf", .body = pdf_text(pages)};
}

}  // namespace

DocumentApi::DocumentApi(const std::filesystem::path& site_folder, const std::filesystem::path& runs_folder)
    : site_(load_site(site_folder)),
      registry_file_(site_.registry_file),
      history_(registry_file_.parent_path() / ".history"),
      audit_(site_.folder),
      runs_(runs_folder, site_.name),
      coverage_(site_),
      places_(site_, coverage_.floor(), audit_),
      hanging_(site_, audit_),
      accepted_(site_.folder, audit_),
      map_(site_, audit_) {}

HttpResponse DocumentApi::answer(const HttpRequest& request) const {
  const std::string& target = request.target;
  if (const std::optional<HttpResponse> places = places_.answer(request))
    return request.method == "PUT" ? *places : unless_known(*places, request);
  if (const std::optional<HttpResponse> hanging = hanging_.answer(request))
    return request.method == "PUT" ? *hanging : unless_known(*hanging, request);
  if (const std::optional<HttpResponse> map = map_.answer(request)) return *map;
  if (const std::optional<HttpResponse> accepted = accepted_.answer(request)) return *accepted;
  if (request.method == "PUT" && target == "/api/markers") return save_markers(request);
  if (request.method == "POST") return post(request);
  if (request.method != "GET" && request.method != "HEAD") return refusal(405, "found another method");

  std::optional<HttpResponse> response = page_file(target);
  if (target == "/api/site") response = site_document();
  if (target == "/api/map") response = map();
  if (target == "/api/map/cells") response = cells();
  if (target == "/api/map/heights") response = heights();
  if (target == "/api/markers") response = markers();
  if (target.starts_with(history_path)) response = history(target);
  if (target == "/api/log") response = json_document(audit_.newest());
  if (!response) response = runs_.answer(request);
  if (!response) return refusal(404, "found no such document");
  return unless_known(*response, request);
}

bool DocumentApi::takes_long(const HttpRequest& head) {
  return head.method == "POST" &&
         (head.target.starts_with("/api/markers/") || head.target == "/api/places/check");
}

bool DocumentApi::uses_files(const HttpRequest& head) {
  return head.target.starts_with("/api/") && head.target != "/api/session" && !takes_long(head);
}

HttpResponse DocumentApi::site_document() const {
  ordered_json goals = ordered_json::array();
  for (const Goal& goal : site_.goals) {
    goals.push_back({{"x_m", goal.position_m.x()}, {"y_m", goal.position_m.y()}});
  }
  ordered_json actions = ordered_json::array();
  for (const ActionHook& hook : site_.actions) actions.push_back(hook.type);
  return json_document({{"name", site_.name},
                        {"actions", actions},
                        {"robot", robot_json(site_.robot)},
                        {"start", pose_json(site_.start)},
                        {"goals", goals},
                        {"routes", routes_json(coverage_.floor().routes)},
                        {"coverage", coverage_json(site_, coverage_.floor())},
                        {"formats", marker_format_names()}});
}

HttpResponse DocumentApi::map() const {
  ordered_json map = map_json(site_.map.map);
  map["heights"] = heights_json(coverage_.floor().heights);
  return json_document(map);
}

std::optional<HttpResponse> DocumentApi::heights() const {
  const std::optional<HeightBands>& heights = coverage_.floor().heights;
  if (!heights) return std::nullopt;
  HttpResponse response{.content_type = "application/octet-stream"};
  for (const std::uint32_t bits : heights->cells)
    for (unsigned byte = 0; byte < sizeof bits; ++byte)
      response.body += static_cast<char>((bits >> (8U * byte)) & 0xFFU);
  return with_etag(std::move(response));
}

HttpResponse DocumentApi::cells() const {
  const std::vector<std::int8_t>& cells = site_.map.map.cells;
  return with_etag({.content_type = "application/octet-stream", .body = {cells.begin(), cells.end()}});
}

HttpResponse DocumentApi::markers() const {
  return {.body = json_text(registry_json(load_registry(registry_file_))),
          .etag = etag_of(file_text(registry_file_, "a registry"))};
}

HttpResponse DocumentApi::save_markers(const HttpRequest& request) const {
  const std::string before = file_text(registry_file_, "a registry");
  if (std::optional<HttpResponse> conflict = conflict_with(before, request.if_match)) return *conflict;
  try {
    const MarkerRegistry after = registry_from_json(request.body);
    if (const std::optional<int> id = repeated_id(after)) {
      return refusal(422, fmt::format("found marker {} twice, wanted each ID once", *id));
    }
    const MarkerRegistry present = load_registry(registry_file_);
    const std::string text = edited_registry_text(before, present, after);
    if (text != before) {
      const int state = history_.keep(before);
      write_file_atomically(registry_file_, text);
      audit_.note({.by = name_of(request),
                   .what = "saved the markers: " + changes_in_words(present, after),
                   .document = "markers",
                   .state = state});
      if (on_saved_) on_saved_(after);
    }
  } catch (const InputError& error) {
    return refusal(422, error.what());
  }
  return markers();
}

HttpResponse DocumentApi::history(const std::string& target) const {
  const std::string rest = target.substr(std::string(history_path).size());
  if (rest.empty()) return json_document(history_json(history_, audit_, "markers"));
  int number = 0;
  const char* const end = rest.data() + rest.size();
  const auto [stop, error] = std::from_chars(rest.data() + 1, end, number);
  if (rest.front() != '/' || error != std::errc() || stop != end) return refusal(404, "found no such state");
  const std::optional<std::string> text = history_.text(number);
  if (!text) return refusal(404, "found no such state");
  return json_document(registry_json(parse_markers(*text, MarkerFormat::lodestar, "history")));
}

HttpResponse DocumentApi::post(const HttpRequest& request) const {
  try {
    if (request.target == "/api/markers/check") {
      return {.body =
                  json_text(coverage_.issues(site_, registry_from_json(request.body), request.cancelled))};
    }
    if (request.target == "/api/markers/deviations") {
      return {.body = json_text(
                  coverage_.deviations(site_, registry_from_json(request.body), request.cancelled))};
    }
    if (request.target == "/api/markers/plan") {
      return {.body = json_text(json{{"text", installation_csv(registry_from_json(request.body),
                                                               site_.map.map, site_.name, today())}})};
    }
    const json body = parse_json(request.body);
    if (request.target == "/api/markers/export") return exported(body);
    if (request.target == "/api/markers/import") return imported(body);
    if (request.target == "/api/markers/print") return printed(body, site_);
  } catch (const InputError& error) {
    return refusal(422, error.what());
  } catch (const json::exception& error) {
    return refusal(422, error.what());
  }
  return refusal(404, "found no such document");
}

}  // namespace lodestar
