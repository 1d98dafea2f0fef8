#include "app/console/map_api.hpp"

#include <chrono>
#include <fmt/chrono.h>
#include <nlohmann/json.hpp>

#include "app/common/base64.hpp"
#include "app/common/json_parse.hpp"
#include "app/console/etag.hpp"
#include "app/console/history_json.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

std::string as_text(const std::vector<std::int8_t>& cells) {
  return {cells.begin(), cells.end()};
}

OccupancyMap drawn_on(OccupancyMap map, const std::string& cells) {
  if (cells.size() != map.cells.size())
    throw InputError(fmt::format("cells: found {}, wanted {}", cells.size(), map.cells.size()));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto value = static_cast<std::int8_t>(cells[i]);
    if (value < OccupancyMap::unknown || value > OccupancyMap::occupied)
      throw InputError(fmt::format("cells: found {}, wanted -1 to 100", static_cast<int>(value)));
    map.cells[i] = value;
  }
  return map;
}

}  // namespace

std::optional<HttpResponse> MapApi::answer(const HttpRequest& request) const {
  if (request.method != "PUT" || request.target != "/api/map/cells") return std::nullopt;
  if (!on_saved_)
    return refusal(409,
                   "found a robot that runs on this map: end it, draw in lodestar serve, and start it again");
  if (is_saved_) return refusal(409, "found a map that was saved just now: load it first");
  try {
    return save(request);
  } catch (const InputError& error) {
    return refusal(422, error.what());
  } catch (const nlohmann::json::exception& error) {
    return refusal(422, error.what());
  } catch (const fs::filesystem_error& error) {
    return refusal(422, error.code().message());
  }
}

HttpResponse MapApi::save(const HttpRequest& request) const {
  const OccupancyMap& before = site_.map.map;
  if (auto conflict = conflict_with(as_text(before.cells), request.if_match)) return *conflict;
  const std::optional<std::string> cells =
      from_base64(parse_json(request.body).at("cells").get_ref<const std::string&>());
  if (!cells) throw InputError("cells: found no base64, wanted it");
  const OccupancyMap after = drawn_on(before, *cells);
  if (after.cells != before.cells) {
    keep_present();
    save_map(after, site_.map_file, site_.map.info.other_keys);
    is_saved_ = true;
    audit_.note({.by = name_of(request), .what = "saved the map", .document = {}});
    on_saved_();
  }
  return {.body = "{}"};
}

/// The map's two files, under the time of the change.
void MapApi::keep_present() const {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const fs::path folder = site_.folder / ".history" / "map" /
                          fmt::format("{:%Y%m%dT%H%M%S}-{:03}", now, now.time_since_epoch().count() % 1000);
  fs::create_directories(folder);
  for (const fs::path& file : {site_.map_file, site_.map.info.image})
    fs::copy_file(file, folder / file.filename(), fs::copy_options::overwrite_existing);
}

}  // namespace lodestar
