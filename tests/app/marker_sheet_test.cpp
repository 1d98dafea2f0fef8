#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "app/markers/sheet.hpp"
#include "maps/marker.hpp"

// Measures the sheets as a person with a ruler would: in the written file, in millimetres on paper.
namespace lodestar {
namespace {

constexpr double mm_per_point = 25.4 / 72.0;

struct Ring {
  Vec2 center_mm;
  double radius_mm = 0.0;
};

/// The circles of a PDF: each begins with a move and consists of four curves; its ends are its extent.
std::vector<Ring> circles_in_pdf(const std::string& pdf) {
  std::vector<Ring> rings;
  std::vector<Vec2> ends;
  double scale = 0.0;
  std::istringstream stream(pdf);
  for (std::string row; std::getline(stream, row);) {
    std::istringstream words(row);
    std::vector<double> numbers;
    double number = 0.0;
    while (words >> number) numbers.push_back(number);
    words.clear();
    std::string op;
    words >> op;
    if (op == "cm") scale = numbers.at(0) * mm_per_point;
    if (op == "c") ends.push_back(scale * Vec2(numbers.at(4), numbers.at(5)));
    if (ends.size() == 4) {
      rings.push_back({0.25 * (ends[0] + ends[1] + ends[2] + ends[3]), 0.5 * (ends[0] - ends[2]).norm()});
      ends.clear();
    }
  }
  return rings;
}

/// The number in quotation marks after a word, from a place of a text on.
double number_after(const std::string& text, const std::string& word, std::size_t from) {
  return std::stod(text.substr(text.find(word + "=\"", from) + word.size() + 2));
}

/// The circles of an SVG whose viewBox is its size in millimetres, y up from the bottom of the first page.
std::vector<Ring> circles_in_svg(const std::string& svg, double height_mm) {
  std::vector<Ring> rings;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) {
    rings.push_back({{number_after(svg, " cx", at), height_mm - number_after(svg, " cy", at)},
                     number_after(svg, " r", at)});
  }
  return rings;
}

/// Each dot lies where the marker has it, of its size, on one sheet.
void expect_marker(const std::vector<Ring>& rings, int id) {
  const std::vector<GridCell> dots = dots_of(id);
  ASSERT_EQ(rings.size(), dots.size());
  const auto o = std::ranges::find(dots, cell_of_o) - dots.begin();
  for (std::size_t i = 0; i < dots.size(); ++i) {
    const Vec2 from_o = rings[i].center_mm - rings[static_cast<std::size_t>(o)].center_mm;
    EXPECT_TRUE(from_o.isApprox(1000.0 * cell_in_marker(dots[i]), 1e-4)) << from_o.transpose();
    EXPECT_NEAR(rings[i].radius_mm, 10.0, 0.001);
  }
}

TEST(MarkerSheet, has_each_dot_of_the_pdf_in_true_scale) {
  const std::string pdf = pdf_text({draw_marker_sheet(447, *paper_named("A4"))});
  expect_marker(circles_in_pdf(pdf), 447);
  EXPECT_THAT(pdf, testing::HasSubstr("/MediaBox [0 0 595.2756 841.8898]"));
  EXPECT_THAT(pdf, testing::HasSubstr("(Marker 447  \\(0x1BF\\))"));
}

TEST(MarkerSheet, has_each_dot_of_the_svg_in_true_scale) {
  const std::string svg = svg_text({draw_marker_sheet(1782, *paper_named("A3"))});
  expect_marker(circles_in_svg(svg, 420.0), 1782);
  EXPECT_THAT(svg, testing::HasSubstr("width=\"297mm\" height=\"420mm\" viewBox=\"0 0 297 420\""));
}

TEST(MarkerSheet, has_a_ruler_of_100_mm_and_keeps_to_the_page) {
  for (const char* name : {"A4", "A3"}) {
    const PaperSize paper = *paper_named(name);
    const SheetPage page = draw_marker_sheet(4095, paper);
    double longest_thin = 0.0;
    for (const SheetMark& mark : page.marks) {
      if (const auto* line = std::get_if<SheetLine>(&mark)) {
        for (const Vec2& end : {line->from_mm, line->to_mm}) {
          EXPECT_TRUE(end.x() > 5 && end.y() > 5 && end.x() < paper.width_mm - 5 &&
                      end.y() < paper.height_mm - 5);
        }
        if (line->width_mm == 0.2)
          longest_thin = std::max(longest_thin, (line->to_mm - line->from_mm).norm());
      }
    }
    EXPECT_DOUBLE_EQ(longest_thin, 100.0);
  }
}

TEST(MarkerSheet, lists_its_objects_where_they_are) {
  const std::string pdf =
      pdf_text({draw_marker_sheet(1, *paper_named("A4")), draw_marker_sheet(2, *paper_named("A4"))});
  const std::size_t table = std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10));
  ASSERT_EQ(pdf.substr(table, 7), "xref\n0 ");
  std::istringstream rows(pdf.substr(table));
  std::string row;
  std::getline(rows, row);
  std::getline(rows, row);
  std::getline(rows, row);
  for (int object = 1; object <= 7; ++object) {
    std::getline(rows, row);
    const std::string wanted = std::to_string(object) + " 0 obj";
    EXPECT_EQ(pdf.substr(std::stoul(row), wanted.size()), wanted);
  }
}

}  // namespace
}  // namespace lodestar
