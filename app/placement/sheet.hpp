#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "maps/geometry.hpp"

// Sheets to make markers from, in true scale: dots, cut marks, a ruler to check the print, the arrow O to X,
// and crosses to drill or glue by. A sheet shows the downward face, as the camera sees it.
namespace lodestar {

struct PaperSize {
  double width_mm = 210.0;
  double height_mm = 297.0;
};

/// "A4" or "A3"; nothing for other words.
std::optional<PaperSize> paper_named(std::string_view name);

/// Millimetres from the lower left corner of the page, y up.
struct SheetLine {
  Vec2 from_mm;
  Vec2 to_mm;
  double width_mm = 0.2;
};
struct SheetCircle {
  Vec2 center_mm;
  double radius_mm = 0.0;
  bool filled = false;  ///< light gray; outlined in any case
};
struct SheetText {
  Vec2 start_mm;  ///< left end of the base line
  double size_mm = 4.0;
  std::string words;  ///< printable ASCII
};

using SheetMark = std::variant<SheetLine, SheetCircle, SheetText>;

struct SheetPage {
  PaperSize paper;
  std::vector<SheetMark> marks;
};

/// One marker, centred on a page.
SheetPage draw_marker_sheet(int id, PaperSize paper);

/// All pages, one below the other, in one drawing in true scale.
std::string svg_text(const std::vector<SheetPage>& pages);

/// A PDF 1.4 file, its drawing commands uncompressed and in millimetres.
std::string pdf_text(const std::vector<SheetPage>& pages);

}  // namespace lodestar
