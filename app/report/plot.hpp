#pragma once

#include <string>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

/// One curve of a plot, or an area between zero and the curve.
struct PlotSeries {
  std::string name;
  std::string css_class;     ///< sets its colour
  std::vector<Vec2> points;  ///< time in seconds (or what is on the x axis), value
  bool filled = false;
};

/// How a plot's axes are drawn.
struct PlotAxes {
  std::string x_name;        ///< label below the axis; empty: time in seconds, as the page's heading says
  bool logarithmic = false;  ///< of the values; those not above zero are omitted
};

/// A plot over time, or over `axes.x_name`, as an SVG element: axes with round ticks, a legend, the series
/// thinned to screen resolution (the extremes of each group of points are kept).
std::string plot_svg(const std::string& title, const std::string& unit, const std::vector<PlotSeries>& given,
                     const PlotAxes& axes = {});

/// Text escaped for HTML and SVG.
std::string escaped(const std::string& text);

}  // namespace lodestar
