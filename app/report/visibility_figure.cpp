#include "app/report/visibility_figure.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace lodestar {
namespace {

// Blue, green, red; by markers seen at the worst heading, the last for all above.
const std::array cell_colors{cv::Scalar(120, 120, 235), cv::Scalar(150, 225, 255), cv::Scalar(170, 225, 170),
                             cv::Scalar(110, 185, 90)};
const std::array cell_words{"none", "one", "two", "three or more markers, at every heading"};
const cv::Scalar title_ink(40, 40, 40);
const cv::Scalar marker_cross_color(0, 140, 255);

void draw_legend(Canvas& canvas) {
  Vec2 at = canvas.pixel(canvas.low_m()) + Vec2(0.0, 45.0);
  constexpr double text_px = 20.0;
  for (std::size_t i = 0; i < cell_colors.size(); ++i) {
    canvas.draw_box_px(at - Vec2(0.0, 12.0), at + Vec2(24.0, 12.0), cell_colors.at(i));
    canvas.draw_text_px(at + Vec2(34.0, 0.0), cell_words.at(i), text_px, title_ink);
    at.x() += 74.0 + Canvas::text_width_px(cell_words.at(i), text_px);
  }
}

}  // namespace

cv::Scalar visibility_color(int markers) {
  return cell_colors.at(std::min(static_cast<std::size_t>(markers), cell_colors.size() - 1));
}

void draw_visible_cells(Canvas& canvas, const Visibility& visibility) {
  const OccupancyMap& map = visibility.map;
  const Vec2 half_px = Vec2::Constant(0.5 * map.resolution_m * canvas.pixels_per_m());
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const std::optional<CellView>& cell = visibility.cells[map.index({column, row})];
      if (!cell) continue;
      const Vec2 at = canvas.pixel(map.center_of({column, row}));
      canvas.draw_box_px(at - half_px, at + half_px, visibility_color(cell->least));
    }
  }
}

cv::Mat draw_visibility(const Visibility& visibility, const MarkerRegistry& registry) {
  constexpr double width_px = 1800.0;
  Canvas canvas = canvas_for(visibility.map, width_px,
                             {.left_px = 40.0, .right_px = 40.0, .top_px = 40.0, .bottom_px = 90.0});
  canvas.draw_map(visibility.map);
  draw_visible_cells(canvas, visibility);
  canvas.draw_frame();
  for (const RegisteredMarker& marker : registry.markers) {
    const Vec2 at = canvas.pixel(map_from_marker(registry, marker).translation().head<2>());
    canvas.draw_disc_px(at, 7.0, marker_cross_color);
    canvas.draw_label_px(at + Vec2(0.0, 20.0), fmt::format("{}", marker.id), 15.0, title_ink, 0.5);
  }
  draw_legend(canvas);
  return canvas.picture();
}

}  // namespace lodestar
