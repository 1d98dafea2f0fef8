#pragma once

#include "app/placement/visibility.hpp"
#include "app/report/canvas.hpp"

namespace lodestar {

/// By markers seen at the worst heading: the colour of a cell.
cv::Scalar visibility_color(int markers);

/// The cells where the robot can be, each coloured by the markers it sees there at the worst heading.
void draw_visible_cells(Canvas& canvas, const Visibility& visibility);

/// The map, its cells so coloured, and the markers.
cv::Mat draw_visibility(const Visibility& visibility, const MarkerRegistry& registry);

}  // namespace lodestar
