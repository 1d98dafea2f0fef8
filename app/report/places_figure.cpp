#include "app/report/places_figure.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "maps/zones.hpp"

namespace lodestar {
namespace {

// Blue, green, red.
const cv::Scalar keep_out_ink(60, 60, 200);
const cv::Scalar speed_zone_ink(0, 150, 200);
const cv::Scalar edge_ink(170, 130, 90);
const cv::Scalar place_ink(110, 60, 110);

constexpr double name_px = 12.0;
constexpr double hatch_px = 12.0;  ///< between two strokes
constexpr double probe_px = 2.0;   ///< a stroke is as exact as this at its ends

void draw_outline(Canvas& canvas, const Polygon& corners_m, const cv::Scalar& color) {
  std::vector<Vec2> closed = corners_m;
  closed.push_back(corners_m.front());
  canvas.draw_line(closed, color, 2.0);
}

Vec2 middle_of(const Polygon& corners_m) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& corner : corners_m) sum += corner;
  return sum / static_cast<double>(corners_m.size());
}

/// Strokes across, where they are inside; only as far as the picture shows.
void hatch(Canvas& canvas, const Polygon& corners_m) {
  Vec2 low = canvas.high_m();
  Vec2 high = canvas.low_m();
  for (const Vec2& corner : corners_m) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  low = low.cwiseMax(canvas.low_m());
  high = high.cwiseMin(canvas.high_m());
  const double spacing_m = hatch_px / canvas.pixels_per_m();
  const Vec2 probe_m = Vec2::Constant(probe_px / canvas.pixels_per_m());
  for (double offset_m = low.y() - high.x(); offset_m < high.y() - low.x(); offset_m += spacing_m) {
    // Along y = x + offset, from the lower or left side of the box to the upper or right one.
    const double from_x = std::max(low.x(), low.y() - offset_m);
    const double to_x = std::min(high.x(), high.y() - offset_m);
    for (Vec2 at_m(from_x, from_x + offset_m); at_m.x() < to_x; at_m += probe_m)
      if (distance_to(corners_m, at_m + 0.5 * probe_m) == 0.0)
        canvas.draw_line({at_m, at_m + probe_m}, keep_out_ink, 1.0);
  }
}

void draw_arrow(Canvas& canvas, const Vec2& from_m, const Vec2& to_m) {
  constexpr double long_px = 12.0;
  const Vec2 tip_px = canvas.pixel(0.5 * (from_m + to_m));
  const double heading_rad = heading_of(canvas.pixel(from_m) - canvas.pixel(to_m));
  for (const double side_rad : {-0.4, 0.4}) {
    const double back_rad = heading_rad + side_rad;
    canvas.draw_line_px(tip_px, tip_px + long_px * Vec2(std::cos(back_rad), std::sin(back_rad)), edge_ink,
                        2.0);
  }
}

void draw_edges(Canvas& canvas, const Places& places) {
  for (const RouteEdge& edge : places.edges) {
    const std::optional<Vec2> from_m = places.position_m(edge.from);
    const std::optional<Vec2> to_m = places.position_m(edge.to);
    if (!from_m || !to_m) continue;
    canvas.draw_line({*from_m, *to_m}, edge_ink, 2.0);
    if (edge.one_way) draw_arrow(canvas, *from_m, *to_m);
  }
  for (const RouteNode& node : places.nodes) canvas.draw_disc(node.position_m, 4.0, edge_ink);
}

}  // namespace

void draw_places(Canvas& canvas, const Places& places) {
  for (const KeepOut& zone : places.keep_out) {
    hatch(canvas, zone.corners_m);
    draw_outline(canvas, zone.corners_m, keep_out_ink);
  }
  for (const SpeedZone& zone : places.speed_zones) {
    draw_outline(canvas, zone.corners_m, speed_zone_ink);
    canvas.draw_label_px(canvas.pixel(middle_of(zone.corners_m)), fmt::format("{:g} m/s", zone.max_mps),
                         name_px, speed_zone_ink, 0.5);
  }
  draw_edges(canvas, places);
  for (const Place& place : places.places) {
    canvas.draw_ring(place.position_m, 6.0, place_ink, 2.0);
    canvas.draw_label_px(canvas.pixel(place.position_m) + Vec2(0.0, -27.0), place.name, name_px, place_ink,
                         0.5);
  }
}

}  // namespace lodestar
