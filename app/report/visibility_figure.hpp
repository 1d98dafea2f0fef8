#pragma once

#include "app/placement/visibility.hpp"
#include "app/report/canvas.hpp"

namespace lodestar {

/// The colour of a cell from which this many markers are seen at the worst heading.
cv::Scalar visibility_color(int markers);

/// The cells where the robot can be, each coloured by the markers it sees there at the worst heading.
void draw_visible_cells(Canvas& canvas, const Visibility& visibility);

/// The map with its cells coloured this way, and the markers.
cv::Mat draw_visibility(const Visibility& visibility, const MarkerRegistry& registry);

}  // namespace lodestar
