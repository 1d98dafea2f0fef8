#include "app/report/plot.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "app/report/ticks.hpp"

namespace lodestar {
namespace {

constexpr double width = 900.0;
constexpr double height = 220.0;
constexpr double left = 60.0;
constexpr double right = 12.0;
constexpr double top = 34.0;
constexpr double bottom = 32.0;
constexpr std::size_t most_points = 900;

struct Extent {
  Vec2 low = Vec2::Constant(1e300);
  Vec2 high = Vec2::Constant(-1e300);
};

/// Values as plotted: unchanged, or as decimal logarithms.
std::vector<PlotSeries> scaled(std::vector<PlotSeries> series, bool logarithmic) {
  if (!logarithmic) return series;
  for (PlotSeries& one : series) {
    std::erase_if(one.points, [](const Vec2& point) { return !(point.y() > 0.0); });
    for (Vec2& point : one.points) point.y() = std::log10(point.y());
  }
  return series;
}

/// Linear axes always include zero, so that sizes of errors can be compared; logarithmic ones span whole
/// decades.
Extent extent_of(const std::vector<PlotSeries>& series, bool logarithmic) {
  Extent extent;
  for (const PlotSeries& one : series) {
    for (const Vec2& point : one.points) {
      extent.low = extent.low.cwiseMin(point);
      extent.high = extent.high.cwiseMax(point);
    }
  }
  if (logarithmic && extent.low.x() <= extent.high.x()) {
    extent.low.y() = std::floor(extent.low.y());
    extent.high.y() = std::max(std::ceil(extent.high.y()), extent.low.y() + 1.0);
    return extent;
  }
  extent.low.y() = std::min(extent.low.y(), 0.0);
  extent.high.y() = std::max(extent.high.y(), extent.low.y() + 1e-6);
  if (extent.low.x() > extent.high.x()) extent = {Vec2(0.0, 0.0), Vec2(1.0, 1.0)};
  extent.high.y() += 0.05 * (extent.high.y() - extent.low.y());
  return extent;
}

/// The minimum and the maximum of each group of points, in order.
std::vector<Vec2> thinned(const std::vector<Vec2>& points) {
  if (points.size() <= most_points) return points;
  const std::size_t stretch = 2 * points.size() / most_points + 1;
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < points.size(); i += stretch) {
    const auto begin = points.begin() + static_cast<std::ptrdiff_t>(i);
    const auto end = points.begin() + static_cast<std::ptrdiff_t>(std::min(i + stretch, points.size()));
    auto [least, greatest] =
        std::minmax_element(begin, end, [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); });
    if (greatest < least) std::swap(least, greatest);
    result.push_back(*least);
    if (least != greatest) result.push_back(*greatest);
  }
  return result;
}

Vec2 on_sheet(const Vec2& point, const Extent& extent) {
  const Vec2 share = (point - extent.low).cwiseQuotient(extent.high - extent.low);
  return {left + share.x() * (width - left - right), height - bottom - share.y() * (height - top - bottom)};
}

std::string grid_svg(const Extent& extent, bool logarithmic) {
  std::string svg;
  const double step_x = tick_spacing(extent.high.x() - extent.low.x(), 10.0);
  for (double x = std::ceil(extent.low.x() / step_x) * step_x; x <= extent.high.x(); x += step_x) {
    const double at = on_sheet({x, 0.0}, extent).x();
    svg += fmt::format("<text class='tick' x='{:.1f}' y='{:.1f}' text-anchor='middle'>{:g}</text>", at,
                       height - bottom + 16.0, x);
  }
  const double step_y = logarithmic ? 1.0 : tick_spacing(extent.high.y() - extent.low.y(), 5.0);
  for (int k = static_cast<int>(std::ceil(extent.low.y() / step_y)); k * step_y <= extent.high.y(); ++k) {
    const double at = on_sheet({0.0, k * step_y}, extent).y();
    svg += fmt::format("<line class='grid' x1='{0:.1f}' x2='{1:.1f}' y1='{2:.1f}' y2='{2:.1f}'/>", left,
                       width - right, at);
    svg += fmt::format("<text class='tick' x='{:.1f}' y='{:.1f}' text-anchor='end'>{:g}</text>", left - 6.0,
                       at + 4.0, logarithmic ? std::pow(10.0, k) : k * step_y);
  }
  return svg;
}

std::string curve_svg(const PlotSeries& series, const Extent& extent) {
  if (series.points.empty()) return "";
  std::string points;
  const std::vector<Vec2> shown = thinned(series.points);
  if (series.filled) {
    const Vec2 first = on_sheet({shown.front().x(), 0.0}, extent);
    points += fmt::format("{:.1f},{:.1f} ", first.x(), first.y());
  }
  for (const Vec2& point : shown) {
    const Vec2 at = on_sheet(point, extent);
    points += fmt::format("{:.1f},{:.1f} ", at.x(), at.y());
  }
  if (series.filled) {
    const Vec2 last = on_sheet({shown.back().x(), 0.0}, extent);
    points += fmt::format("{:.1f},{:.1f}", last.x(), last.y());
  }
  return fmt::format("<{} class='{}' points='{}'/>", series.filled ? "polygon" : "polyline", series.css_class,
                     points);
}

std::string legend_svg(const std::vector<PlotSeries>& series) {
  std::string svg;
  double x = width - right;
  for (auto one = series.rbegin(); one != series.rend(); ++one) {
    x -= 7.6 * static_cast<double>(one->name.size());
    svg += fmt::format("<text class='legend' x='{:.1f}' y='20'>{}</text>", x, escaped(one->name));
    svg += fmt::format("<rect class='{} key' x='{:.1f}' y='10' width='14' height='10'/>", one->css_class,
                       x - 20.0);
    x -= 42.0;
  }
  return svg;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string plot_svg(const std::string& title, const std::string& unit, const std::vector<PlotSeries>& given,
                     const PlotAxes& axes) {
  const std::vector<PlotSeries> series = scaled(given, axes.logarithmic);
  const Extent extent = extent_of(series, axes.logarithmic);
  std::string svg =
      fmt::format("<svg viewBox='0 0 {} {}' role='img' aria-label='{}'>", width, height, escaped(title));
  svg += fmt::format("<text class='title' x='{}' y='20'>{} <tspan class='unit'>({})</tspan></text>", left,
                     escaped(title), escaped(unit));
  svg += grid_svg(extent, axes.logarithmic);
  if (!axes.x_name.empty())
    svg += fmt::format("<text class='unit' x='{}' y='{}' text-anchor='end'>{}</text>", width - right,
                       height - 4.0, escaped(axes.x_name));
  for (const PlotSeries& one : series) svg += curve_svg(one, extent);
  svg += legend_svg(series);
  return svg + "</svg>\n";
}

}  // namespace lodestar
