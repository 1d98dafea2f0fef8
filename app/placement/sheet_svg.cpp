#include <fmt/format.h>

#include "app/placement/sheet.hpp"

namespace lodestar {
namespace {

/// Writes the marks of a page whose lower edge is `bottom_mm` below the drawing's top, with y down.
class SvgWriter {
 public:
  SvgWriter(std::string& text, double bottom_mm) : text_(text), bottom_mm_(bottom_mm) {}

  void operator()(const SheetLine& line) const {
    text_ +=
        fmt::format("<line x1=\"{:g}\" y1=\"{:g}\" x2=\"{:g}\" y2=\"{:g}\" stroke-width=\"{:g}\"/>\n",
                    line.from_mm.x(), down(line.from_mm), line.to_mm.x(), down(line.to_mm), line.width_mm);
  }
  void operator()(const SheetCircle& circle) const {
    text_ += fmt::format("<circle cx=\"{:g}\" cy=\"{:g}\" r=\"{:g}\" fill=\"{}\" stroke-width=\"0.2\"/>\n",
                         circle.center_mm.x(), down(circle.center_mm), circle.radius_mm,
                         circle.filled ? "#d9d9d9" : "none");
  }
  void operator()(const SheetText& text) const {
    text_ += fmt::format(
        "<text x=\"{:g}\" y=\"{:g}\" font-size=\"{:g}\" fill=\"black\" stroke=\"none\">{}</text>\n",
        text.start_mm.x(), down(text.start_mm), text.size_mm, text.words);
  }

 private:
  [[nodiscard]] double down(const Vec2& at_mm) const { return bottom_mm_ - at_mm.y(); }

  std::string& text_;
  double bottom_mm_;
};

}  // namespace

std::string svg_text(const std::vector<SheetPage>& pages) {
  double width_mm = 0.0;
  double height_mm = 0.0;
  std::string marks;
  for (const SheetPage& page : pages) {
    width_mm = std::max(width_mm, page.paper.width_mm);
    height_mm += page.paper.height_mm;
    const SvgWriter writer(marks, height_mm);
    for (const SheetMark& mark : page.marks) std::visit(writer, mark);
  }
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}mm\" height=\"{1:g}mm\" "
             "viewBox=\"0 0 {0:g} {1:g}\" stroke=\"black\" font-family=\"Helvetica, Arial, sans-serif\">\n",
             width_mm, height_mm) +
         marks + "</svg>\n";
}

}  // namespace lodestar
