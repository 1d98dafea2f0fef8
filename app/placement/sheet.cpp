#include "app/placement/sheet.hpp"

#include <fmt/format.h>

#include "maps/marker.hpp"

namespace lodestar {
namespace {

constexpr double pitch_mm = marker_pitch_m * mm_per_m;
constexpr double dot_radius_mm = marker_dot_radius_m * mm_per_m;
constexpr double side_mm = (marker_grid_size - 1) * pitch_mm;
constexpr double margin_mm = 20.0;  ///< from the centres of the outer dots to the cut

class Drawing {
 public:
  Drawing(PaperSize paper, Vec2 o_mm) : page_{paper, {}}, o_mm_(std::move(o_mm)) {}

  /// From here on all coordinates are relative to the centre of dot O.
  void line(const Vec2& from_mm, const Vec2& to_mm, double width_mm = 0.2) {
    page_.marks.emplace_back(SheetLine{o_mm_ + from_mm, o_mm_ + to_mm, width_mm});
  }
  void circle(const Vec2& center_mm, double radius_mm, bool filled) {
    page_.marks.emplace_back(SheetCircle{o_mm_ + center_mm, radius_mm, filled});
  }
  void text(const Vec2& start_mm, double size_mm, std::string words) {
    page_.marks.emplace_back(SheetText{o_mm_ + start_mm, size_mm, std::move(words)});
  }
  [[nodiscard]] SheetPage page() const { return page_; }

 private:
  SheetPage page_;
  Vec2 o_mm_;
};

void draw_dots(Drawing& drawing, int id) {
  constexpr double cross_mm = 3.0;
  for (const GridCell& cell : dots_of(id)) {
    const Vec2 center = mm_per_m * cell_in_marker(cell);
    drawing.circle(center, dot_radius_mm, true);
    drawing.line(center - Vec2(cross_mm, 0.0), center + Vec2(cross_mm, 0.0));
    drawing.line(center - Vec2(0.0, cross_mm), center + Vec2(0.0, cross_mm));
  }
}

/// Two short lines outside each corner of the square to cut out.
void draw_cut_marks(Drawing& drawing) {
  constexpr double gap_mm = 2.0;
  constexpr double length_mm = 8.0;
  for (const double right : {0.0, 1.0}) {
    for (const double top : {0.0, 1.0}) {
      const Vec2 corner(right * side_mm + (2.0 * right - 1.0) * margin_mm,
                        top * side_mm + (2.0 * top - 1.0) * margin_mm);
      const Vec2 x(2.0 * right - 1.0, 0.0);
      const Vec2 y(0.0, 2.0 * top - 1.0);
      drawing.line(corner + gap_mm * x, corner + (gap_mm + length_mm) * x);
      drawing.line(corner + gap_mm * y, corner + (gap_mm + length_mm) * y);
    }
  }
}

void draw_arrow(Drawing& drawing) {
  constexpr double below_mm = -16.0;
  constexpr double head_mm = 4.0;
  const Vec2 tip(side_mm, below_mm);
  drawing.line({0.0, below_mm}, tip, 0.6);
  drawing.line(tip, tip + Vec2(-head_mm, 0.5 * head_mm), 0.6);
  drawing.line(tip, tip + Vec2(-head_mm, -0.5 * head_mm), 0.6);
  drawing.text({-14.0, -14.0}, 4.0, "O");
  drawing.text({side_mm + 12.0, -14.0}, 4.0, "X");
  drawing.text({-14.0, side_mm + 12.0}, 4.0, "Y");
}

void draw_ruler(Drawing& drawing, double y_mm) {
  constexpr int length_mm = 100;
  drawing.line({0.0, y_mm}, {length_mm, y_mm});
  for (int at = 0; at <= length_mm; at += 10) {
    drawing.line({at, y_mm}, {at, y_mm + (at % 50 == 0 ? 6.0 : 3.0)});
  }
  drawing.text({length_mm + 4.0, y_mm}, 4.0, "100 mm - measure it");
}

}  // namespace

std::optional<PaperSize> paper_named(std::string_view name) {
  if (name == "A4") return PaperSize{210.0, 297.0};
  if (name == "A3") return PaperSize{297.0, 420.0};
  return std::nullopt;
}

SheetPage draw_marker_sheet(int id, PaperSize paper) {
  Drawing drawing(paper, {0.5 * (paper.width_mm - side_mm), 0.5 * (paper.height_mm - side_mm)});
  draw_dots(drawing, id);
  draw_cut_marks(drawing);
  draw_arrow(drawing);
  drawing.text({0.0, side_mm + 42.0}, 9.0, fmt::format("Marker {}  (0x{:03X})", id, id));
  drawing.text(
      {0.0, side_mm + 35.0}, 4.0,
      fmt::format("{} dots of {} mm, {} mm apart", dots_of(id).size(), 2.0 * dot_radius_mm, pitch_mm));
  draw_ruler(drawing, -50.0);
  drawing.text({0.0, -58.0}, 4.0, "Print at 100 %. This face looks down; the arrow O to X is the yaw.");
  drawing.text({0.0, -64.0}, 4.0, "Crosses: the middles of the dots, to drill or to stick by.");
  return drawing.page();
}

}  // namespace lodestar
