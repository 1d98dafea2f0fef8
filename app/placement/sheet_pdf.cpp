#include <array>
#include <fmt/format.h>

#include "app/placement/sheet.hpp"

namespace lodestar {
namespace {

constexpr double points_per_mm = 72.0 / 25.4;

/// Content stream operators (PDF Reference 1.4, chapters 4 and 5), in millimetres by a `cm` at the start.
class PdfMarks {
 public:
  explicit PdfMarks(std::string& text) : text_(text) {}

  void operator()(const SheetLine& line) const {
    text_ += fmt::format("{:g} w {:g} {:g} m {:g} {:g} l S\n", line.width_mm, line.from_mm.x(),
                         line.from_mm.y(), line.to_mm.x(), line.to_mm.y());
  }

  /// Four Bezier curves, within 0.03 % of the radius.
  void operator()(const SheetCircle& circle) const {
    constexpr double handle = 0.5522847498;
    const double r = circle.radius_mm;
    const Vec2 c = circle.center_mm;
    text_ += fmt::format("0.2 w 0.85 g {:g} {:g} m\n", c.x() + r, c.y());
    Vec2 out(r, 0.0);
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Vec2 next(-out.y(), out.x());
      const Vec2 first = c + out + handle * next;
      const Vec2 second = c + next + handle * out;
      const Vec2 end = c + next;
      text_ += fmt::format("{:g} {:g} {:g} {:g} {:g} {:g} c\n", first.x(), first.y(), second.x(), second.y(),
                           end.x(), end.y());
      out = next;
    }
    text_ += circle.filled ? "b\n" : "s\n";
  }

  void operator()(const SheetText& text) const {
    std::string escaped;
    for (const char c : text.words) {
      if (c == '(' || c == ')' || c == '\\') escaped += '\\';
      escaped += c;
    }
    text_ += fmt::format("BT 0 g /F1 {:g} Tf {:g} {:g} Td ({}) Tj ET\n", text.size_mm, text.start_mm.x(),
                         text.start_mm.y(), escaped);
  }

 private:
  std::string& text_;
};

std::string content_of(const SheetPage& page) {
  std::string content = fmt::format("{:.9f} 0 0 {:.9f} 0 0 cm\n", points_per_mm, points_per_mm);
  const PdfMarks writer(content);
  for (const SheetMark& mark : page.marks) std::visit(writer, mark);
  return content;
}

/// Objects in order, their byte offsets, and the cross-reference table at the end.
class PdfFile {
 public:
  void add(const std::string& object) {
    places_.push_back(text_.size());
    text_ += fmt::format("{} 0 obj\n{}\nendobj\n", places_.size(), object);
  }

  [[nodiscard]] std::string finished() const {
    std::string text = text_;
    text += fmt::format("xref\n0 {}\n0000000000 65535 f \n", places_.size() + 1);
    for (const std::size_t place : places_) text += fmt::format("{:010} 00000 n \n", place);
    text += fmt::format("trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n", places_.size() + 1,
                        text_.size());
    return text;
  }

 private:
  std::string text_ = "%PDF-1.4\n";
  std::vector<std::size_t> places_;
};

}  // namespace

std::string pdf_text(const std::vector<SheetPage>& pages) {
  constexpr std::size_t first_page = 4;  // after the catalog, the list of pages and the font
  std::string kids;
  for (std::size_t i = 0; i < pages.size(); ++i) kids += fmt::format("{} 0 R ", first_page + 2 * i);
  PdfFile file;
  file.add("<< /Type /Catalog /Pages 2 0 R >>");
  file.add(fmt::format("<< /Type /Pages /Count {} /Kids [ {}] >>", pages.size(), kids));
  file.add("<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>");
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const SheetPage& page = pages[i];
    const std::string content = content_of(page);
    file.add(fmt::format(
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.4f} {:.4f}] /Contents {} 0 R "
        "/Resources << /Font << /F1 3 0 R >> >> >>",
        points_per_mm * page.paper.width_mm, points_per_mm * page.paper.height_mm, first_page + 2 * i + 1));
    file.add(fmt::format("<< /Length {} >>\nstream\n{}endstream", content.size(), content));
  }
  return file.finished();
}

}  // namespace lodestar
