#include "app/console/hanging_api.hpp"

#include <charconv>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/base64.hpp"
#include "app/common/json_parse.hpp"
#include "app/common/wall_clock.hpp"
#include "app/console/etag.hpp"
#include "app/placement/hanging.hpp"
#include "app/placement/installation.hpp"
#include "app/placement/registry_check.hpp"
#include "maps/atomic_file.hpp"
#include "maps/file_text.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::string_view hanging_path = "/api/hanging";

ordered_json metres(const std::optional<double>& value_m) {
  return value_m ? ordered_json(std::round(*value_m * 1e3) / 1e3) : ordered_json(nullptr);
}

ordered_json marker_json(const MarkerRegistry& registry, const RegisteredMarker& marker, const Site& site) {
  const Vec3 center_m = center_in_map(registry, marker);
  const WallDistances walls = wall_distances(site.map.map, center_m.head<2>());
  return {{"id", marker.id},
          {"x_m", center_m.x()},
          {"y_m", center_m.y()},
          {"z_m", center_m.z()},
          {"yaw_deg", degrees(flattened(map_from_marker(registry, marker)).yaw_rad)},
          {"walls",
           {{"left", metres(walls.left_m)},
            {"right", metres(walls.right_m)},
            {"below", metres(walls.below_m)},
            {"above", metres(walls.above_m)}}}};
}

/// The whole number that the text is.
std::optional<int> id_in(std::string_view text) {
  int id = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  const bool is_id =
      error == std::errc() && stop == text.data() + text.size() && id >= 0 && id < marker_id_count;
  return is_id ? std::optional(id) : std::nullopt;
}

}  // namespace

std::optional<HttpResponse> HangingApi::answer(const HttpRequest& request) const {
  if (!request.target.starts_with(hanging_path)) return std::nullopt;
  const bool reads = request.method == "GET" || request.method == "HEAD";
  std::string_view rest = std::string_view(request.target).substr(hanging_path.size());
  rest = rest.substr(0, rest.find('?'));  // by which a page tells a new photo from the one before
  try {
    if (reads && rest.empty()) return list();
    if (!rest.starts_with('/')) return std::nullopt;
    rest.remove_prefix(1);
    constexpr std::string_view photo_ending = "/photo";
    constexpr std::string_view picture_ending = ".jpg";
    if (reads && rest.ends_with(picture_ending)) {
      const std::optional<int> id = id_in(rest.substr(0, rest.size() - picture_ending.size()));
      return id ? photo(*id) : refusal(404, "found no such photo");
    }
    if (request.method != "PUT") return std::nullopt;
    const bool is_photo = rest.ends_with(photo_ending);
    const std::optional<int> id = id_in(is_photo ? rest.substr(0, rest.size() - photo_ending.size()) : rest);
    if (!id) return refusal(404, "found no such marker");
    return is_photo ? keep_photo(*id, request) : set(*id, request);
  } catch (const InputError& error) {
    return refusal(422, error.what());
  } catch (const json::exception& error) {
    return refusal(422, error.what());
  }
}

HttpResponse HangingApi::list() const {
  const MarkerRegistry registry = load_registry(site_.registry_file);
  const std::map<int, HungMarker> hung = load_hanging(site_.folder);
  ordered_json markers = ordered_json::array();
  for (const RegisteredMarker& marker : registry.markers) {
    ordered_json item = marker_json(registry, marker, site_);
    const auto found = hung.find(marker.id);
    const HungMarker how = found == hung.end() ? HungMarker{} : found->second;
    item.update({{"state", to_string(how.state)},
                 {"by", how.by},
                 {"at", how.at},
                 {"photo", fs::exists(photo_file(marker.id))}});
    markers.push_back(std::move(item));
  }
  return json_document(markers);
}

HttpResponse HangingApi::set(int id, const HttpRequest& request) const {
  constexpr std::size_t longest_name = 40;
  const json sent = parse_json(request.body);
  const auto word = sent.at("state").get<std::string>();
  const std::optional<HangingState> state = hanging_state_named(word);
  if (!state) return refusal(422, "found '" + word + "', wanted planned, hung or verified");
  const auto by = sent.value("by", "");
  if (by.size() > longest_name) return refusal(422, "found a long name, wanted at most 40 bytes");
  const MarkerRegistry registry = load_registry(site_.registry_file);
  if (std::ranges::find(registry.markers, id, &RegisteredMarker::id) == registry.markers.end())
    return refusal(422, fmt::format("found marker {}, which is not among the saved ones", id));
  std::map<int, HungMarker> hung = load_hanging(site_.folder);
  hung[id] = {.state = *state, .by = by, .at = utc_text()};
  save_hanging(hung, site_.folder);
  audit_.note({.by = by, .what = fmt::format("marker {}: {}", id, word), .document = {}});
  return list();
}

HttpResponse HangingApi::keep_photo(int id, const HttpRequest& request) const {
  constexpr std::string_view jpeg_begins = "\xFF\xD8\xFF";
  const std::optional<std::string> jpeg = from_base64(parse_json(request.body).at("jpeg").get<std::string>());
  if (!jpeg || !jpeg->starts_with(jpeg_begins))
    return refusal(422, "found no JPEG in base64, wanted a photo");
  fs::create_directories(photo_file(id).parent_path());
  write_file_atomically(photo_file(id), *jpeg);
  return list();
}

HttpResponse HangingApi::photo(int id) const {
  if (!fs::exists(photo_file(id))) return refusal(404, "found no such photo");
  return with_etag({.content_type = "image/jpeg", .body = file_text(photo_file(id), "a photo")});
}

fs::path HangingApi::photo_file(int id) const {
  return site_.folder / "photos" / fmt::format("{}.jpg", id);
}

}  // namespace lodestar
