#include "app/placement/place_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "app/placement/installation.hpp"
#include "app/placement/registry_check.hpp"

namespace lodestar {
namespace {

constexpr double page_margin_mm = 12.0;
constexpr double plan_width_mm = 62.0;
constexpr double plan_height_mm = 34.0;  // above the marker's name, on A4
constexpr double step_mm = 0.5;          // of the plan's drawing

/// The sheets' font has these letters only.
std::string ascii(const std::string& words) {
  std::string plain;
  for (const char c : words) {
    const bool continues = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;  // of a letter in UTF-8
    if (!continues) plain += c >= ' ' && c <= '~' ? c : '?';
  }
  return plain;
}

/// "1.030 m from the wall on the left, 0.315 m from the wall above", or of one, or nothing.
std::string words_of(const WallDistances& walls) {
  std::string words;
  for (const auto& wall : {nearer_wall("on the left", walls.left_m, "on the right", walls.right_m),
                           nearer_wall("below", walls.below_m, "above", walls.above_m)}) {
    if (!wall) continue;
    words +=
        fmt::format("{}{:.3f} m from the wall {}", words.empty() ? "" : ", ", wall->distance_m, wall->side);
  }
  return words;
}

}  // namespace

PlaceSheets::PlaceSheets(const OccupancyMap& map, std::string site, std::string date, PaperSize paper)
    : map_(map), head_(ascii(std::move(site) + ", " + std::move(date))), paper_(paper) {
  mm_per_cell_ = std::min(plan_width_mm / map.columns, plan_height_mm / map.rows);
  corner_mm_ = {paper.width_mm - page_margin_mm - mm_per_cell_ * map.columns,
                paper.height_mm - page_margin_mm - mm_per_cell_ * map.rows};
  draw_plan();
}

/// Walls as rows of strokes, coarse enough to be few.
void PlaceSheets::draw_plan() {
  const auto is_wall = [&](int column, int row) {
    const int first = static_cast<int>(column * step_mm / mm_per_cell_);
    const int last = std::max(first, static_cast<int>((column + 1) * step_mm / mm_per_cell_) - 1);
    const int low = static_cast<int>(row * step_mm / mm_per_cell_);
    const int high = std::max(low, static_cast<int>((row + 1) * step_mm / mm_per_cell_) - 1);
    for (int r = low; r <= high; ++r) {
      for (int c = first; c <= last; ++c)
        if (map_.contains({c, r}) && map_.at({c, r}) >= 50) return true;
    }
    return false;
  };
  const int columns = static_cast<int>(std::ceil(mm_per_cell_ * map_.columns / step_mm));
  const int rows = static_cast<int>(std::ceil(mm_per_cell_ * map_.rows / step_mm));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0, end = 0; column < columns; column = end + 1) {
      end = column;
      while (end < columns && is_wall(end, row)) ++end;
      if (end == column) continue;
      const double y_mm = corner_mm_.y() + step_mm * (row + 0.5);
      plan_.emplace_back(SheetLine{
          {corner_mm_.x() + step_mm * column, y_mm}, {corner_mm_.x() + step_mm * end, y_mm}, step_mm});
    }
  }
}

Vec2 PlaceSheets::on_plan_mm(const Vec2& in_map_m) const {
  const Vec2 in_grid = (inverse(map_.map_from_grid) * in_map_m) / map_.resolution_m;
  return corner_mm_ + mm_per_cell_ * in_grid;
}

SheetPage PlaceSheets::page(const MarkerRegistry& registry, const RegisteredMarker& marker) const {
  SheetPage page = draw_marker_sheet(marker.id, paper_);
  const Vec3 center_m = center_in_map(registry, marker);
  const double yaw_rad = flattened(map_from_marker(registry, marker)).yaw_rad - map_.map_from_grid.yaw_rad;
  constexpr double size_mm = 3.5;
  constexpr double row_mm = 5.0;
  double y_mm = paper_.height_mm - page_margin_mm - size_mm;
  for (const std::string& words :
       {head_, fmt::format("centre x {:.3f} m, y {:.3f} m", center_m.x(), center_m.y()),
        fmt::format("{:.3f} m above the floor, face down", center_m.z()),
        fmt::format("arrow O to X at {:.1f} degrees on the plan", degrees(wrap_angle(yaw_rad))),
        words_of(wall_distances(map_, center_m.head<2>()))}) {
    page.marks.emplace_back(SheetText{{page_margin_mm, y_mm}, size_mm, words});
    y_mm -= row_mm;
  }
  page.marks.insert(page.marks.end(), plan_.begin(), plan_.end());
  constexpr double arm_mm = 4.0;
  const Vec2 at_mm = on_plan_mm(center_m.head<2>());
  page.marks.emplace_back(SheetLine{at_mm - Vec2(arm_mm, 0.0), at_mm + Vec2(arm_mm, 0.0), 0.4});
  page.marks.emplace_back(SheetLine{at_mm - Vec2(0.0, arm_mm), at_mm + Vec2(0.0, arm_mm), 0.4});
  return page;
}

}  // namespace lodestar
