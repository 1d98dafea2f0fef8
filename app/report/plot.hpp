#pragma once

#include <string>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

/// One curve of a plot, or an area between zero and the curve.
struct PlotSeries {
  std::string name;
  std::string css_class;     ///< decides its colour
  std::vector<Vec2> points;  ///< time in seconds (or what is on the x axis), value
  bool filled = false;
};

/// How a plot's axes are drawn.
struct PlotAxes {
  std::string x_name;        ///< stands below the axis; empty: it is time in seconds, as the page says
  bool logarithmic = false;  ///< the values; those that are not above zero are left out
};

/// A plot over time, or over `axes.x_name`, as an SVG element: axes with round ticks, a legend, the series
/// thinned out to what a screen can show (the extremes of each stretch are kept).
std::string plot_svg(const std::string& title, const std::string& unit, const std::vector<PlotSeries>& given,
                     const PlotAxes& axes = {});

/// Text that stands safely in HTML and SVG.
std::string escaped(const std::string& text);

}  // namespace lodestar
