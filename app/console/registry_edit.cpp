#include "app/console/registry_edit.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "maps/registry_text.hpp"

namespace lodestar {
namespace {

constexpr double same_m = 1e-9;
constexpr double same_rad = 1e-9;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool same(const RegisteredMarker& a, const RegisteredMarker& b) {
  return (a.position_m - b.position_m).cwiseAbs().maxCoeff() < same_m &&
         std::abs(wrap_angle(a.yaw_rad - b.yaw_rad)) < same_rad;
}

bool same(const Pose2& a, const Pose2& b) {
  return (a.position_m - b.position_m).norm() < same_m &&
         std::abs(wrap_angle(a.yaw_rad - b.yaw_rad)) < same_rad;
}

/// The lines that save_registry would write: [0] the alignment, from [1] on the markers.
std::vector<std::string> fresh_lines(const MarkerRegistry& registry) {
  std::vector<std::string> lines = lines_of(registry_text(registry));
  constexpr std::ptrdiff_t head = 2;  // format and version
  lines.erase(lines.begin(), lines.begin() + head);
  lines.erase(lines.begin() + 1);  // the word "markers:"
  return lines;
}

/// Is each marker written on exactly one line of its own?
bool is_one_a_line(const std::vector<std::string>& lines, const MarkerRegistry& registry) {
  int last = 0;
  for (const RegisteredMarker& marker : registry.markers) {
    if (marker.line <= last || marker.line > static_cast<int>(lines.size())) return false;
    const std::string& line = lines[static_cast<std::size_t>(marker.line) - 1];
    if (!line.starts_with("  - {") || line.find('}') == std::string::npos) return false;
    last = marker.line;
  }
  return !registry.markers.empty();
}

/// The index of the line that is the alignment as a whole.
std::optional<std::size_t> line_of_alignment(const std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].starts_with("alignment: {") && lines[i].find('}') != std::string::npos) return i;
  return std::nullopt;
}

/// What a survey knows of a marker holds for as long as nobody moves it.
MarkerRegistry with_sigmas_of(const MarkerRegistry& before, MarkerRegistry after) {
  for (RegisteredMarker& marker : after.markers) {
    const RegisteredMarker* const old = before.find(marker.id);
    if (old != nullptr && same(*old, marker)) marker.sigma = old->sigma;
  }
  return after;
}

}  // namespace

std::string edited_registry_text(const std::string& text, const MarkerRegistry& before,
                                 const MarkerRegistry& edited_registry) {
  const MarkerRegistry after = with_sigmas_of(before, edited_registry);
  std::vector<std::string> old_lines = lines_of(text);
  const bool alignment_stays = same(before.map_from_registry, after.map_from_registry);
  const std::optional<std::size_t> alignment_line = line_of_alignment(old_lines);
  if (after.markers.empty() || !is_one_a_line(old_lines, before) || (!alignment_stays && !alignment_line)) {
    return registry_text(after);
  }
  const std::vector<std::string> fresh = fresh_lines(after);
  if (!alignment_stays) {
    std::string& line = old_lines[*alignment_line];
    line = fresh.front() + line.substr(line.find('}') + 1);
  }
  std::map<int, std::size_t> place_in_after;
  for (std::size_t i = 0; i < after.markers.size(); ++i) place_in_after.emplace(after.markers[i].id, i);
  std::map<int, const RegisteredMarker*> marker_on_line;
  for (const RegisteredMarker& marker : before.markers) marker_on_line.emplace(marker.line, &marker);

  const int last_marker_line = before.markers.back().line;
  std::string edited;
  for (int number = 1; number <= static_cast<int>(old_lines.size()); ++number) {
    const std::string& line = old_lines[static_cast<std::size_t>(number) - 1];
    const auto old = marker_on_line.find(number);
    if (old == marker_on_line.end()) {
      edited += line + "\n";
    } else if (const auto now = place_in_after.find(old->second->id); now != place_in_after.end()) {
      edited += same(*old->second, after.markers[now->second]) ? line : fresh[now->second + 1];
      edited += "\n";
      place_in_after.erase(now);
    }
    if (number != last_marker_line) continue;
    for (const auto& [id, place] : place_in_after) {
      if (before.find(id) == nullptr) edited += fresh[place + 1] + "\n";
    }
  }
  return edited;
}

}  // namespace lodestar
