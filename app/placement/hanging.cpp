#include "app/placement/hanging.hpp"

#include <array>
#include <fmt/format.h>

#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"
#include "maps/strict_yaml.hpp"
#include "maps/yaml_quoting.hpp"

namespace lodestar {
namespace {

constexpr std::array states{HangingState::planned, HangingState::hung, HangingState::verified};

}  // namespace

std::string_view to_string(HangingState state) {
  switch (state) {
    case HangingState::planned:
      return "planned";
    case HangingState::hung:
      return "hung";
    case HangingState::verified:
      return "verified";
  }
  return "";
}

std::optional<HangingState> hanging_state_named(const std::string& name) {
  const auto* const found =
      std::ranges::find(states, name, [](HangingState state) { return to_string(state); });
  return found == states.end() ? std::nullopt : std::optional(*found);
}

std::map<int, HungMarker> load_hanging(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / hanging_file_name;
  if (!std::filesystem::exists(file)) return {};
  StrictYaml yaml = StrictYaml::load(file);
  if (const std::string format = yaml.text("format"); format != "lodestar-hanging")
    yaml.refuse("format", "'" + format + "'", "'lodestar-hanging'");
  (void)yaml.integer("version", 1, 1);
  std::map<int, HungMarker> markers;
  for (StrictYaml& item : yaml.list_of_mappings("markers")) {
    const int id = item.integer("id", 0, marker_id_count - 1);
    const std::string word = item.text("state");
    const std::optional<HangingState> state = hanging_state_named(word);
    if (!state) item.refuse("state", "'" + word + "'", "planned, hung or verified");
    HungMarker marker{.state = *state, .by = {}, .at = item.text("at")};
    if (item.has("by")) marker.by = item.text("by");
    item.finish();
    if (!markers.emplace(id, std::move(marker)).second)
      item.refuse("id", fmt::format("{} twice", id), "each marker once");
  }
  yaml.finish();
  return markers;
}

void save_hanging(const std::map<int, HungMarker>& markers, const std::filesystem::path& folder) {
  std::string text =
      "format: lodestar-hanging\nversion: 1\nmarkers:" + std::string(markers.empty() ? " []\n" : "\n");
  for (const auto& [id, marker] : markers) {
    text +=
        fmt::format("  - {{id: {}, state: {}, at: {}", id, to_string(marker.state), yaml_quoted(marker.at));
    text += marker.by.empty() ? "}\n" : ", by: " + yaml_quoted(marker.by) + "}\n";
  }
  write_file_atomically(folder / hanging_file_name, text);
}

}  // namespace lodestar
