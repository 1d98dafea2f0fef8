#pragma once

#include <string>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

/// One curve of a plot, or an area between zero and the curve.
struct PlotSeries {
  std::string name;
  std::string css_class;     ///< decides its colour
  std::vector<Vec2> points;  ///< time in seconds, value
  bool filled = false;
};

/// A plot over time as an SVG element: axes with round ticks, a legend, the series thinned out to what a
/// screen can show (the extremes of each stretch are kept).
std::string plot_svg(const std::string& title, const std::string& unit,
                     const std::vector<PlotSeries>& series);

/// Text that stands safely in HTML and SVG.
std::string escaped(const std::string& text);

}  // namespace lodestar
