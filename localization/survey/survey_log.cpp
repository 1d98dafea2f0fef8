#include "localization/survey/survey_log.hpp"

#include <algorithm>
#include <optional>

namespace lodestar {
namespace {

std::optional<DetectedMarker> whole(const SightedMarker& sighted) {
  DetectedMarker marker{.id = sighted.id, .confidence = 1.0, .dots = sighted.dots};
  const auto take = [&](GridCell cell, Vec2& center_px) {
    const auto dot = std::ranges::find(sighted.dots, cell, &MarkerDot::cell);
    if (dot == sighted.dots.end()) return false;
    center_px = dot->center_px;
    return true;
  };
  const bool is_whole =
      take(cell_of_o, marker.o_px) && take(cell_of_x, marker.x_px) && take(cell_of_y, marker.y_px);
  marker.center_px = 0.5 * (marker.x_px + marker.y_px);
  return is_whole ? std::optional(marker) : std::nullopt;
}

}  // namespace

std::vector<DetectedMarker> whole_markers(const SurveyFrame& frame) {
  std::vector<DetectedMarker> markers;
  for (const SightedMarker& sighted : frame.markers)
    if (const std::optional<DetectedMarker> marker = whole(sighted)) markers.push_back(*marker);
  return markers;
}

}  // namespace lodestar
