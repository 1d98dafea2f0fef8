#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "app/placement/place_sheet.hpp"
#include "maps/marker.hpp"

// Measures the sheets as with a ruler: in the written file, in millimetres on paper.
namespace lodestar {
namespace {

using ::testing::HasSubstr;

constexpr double mm_per_point = 25.4 / 72.0;

struct Ring {
  Vec2 center_mm;
  double radius_mm = 0.0;
};

/// The circles of a PDF: each begins with a move and has four curves, whose end points give its extent.
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

struct Stroke {
  Vec2 from_mm;
  Vec2 to_mm;
  double width_mm = 0.0;
};

/// The straight lines of a PDF: `W w X Y m X Y l S`, one per row.
std::vector<Stroke> strokes_in_pdf(const std::string& pdf) {
  std::vector<Stroke> strokes;
  double scale = 0.0;
  std::istringstream stream(pdf);
  for (std::string row; std::getline(stream, row);) {
    std::istringstream words(row);
    if (row.ends_with(" cm")) {
      words >> scale;
      scale *= mm_per_point;
    }
    if (!row.ends_with(" l S")) continue;
    Stroke stroke;
    std::string op;
    words >> stroke.width_mm >> op >> stroke.from_mm.x() >> stroke.from_mm.y() >> op >> stroke.to_mm.x() >>
        stroke.to_mm.y();
    strokes.push_back({scale * stroke.from_mm, scale * stroke.to_mm, scale * stroke.width_mm});
  }
  return strokes;
}

/// Number of strokes that are this line, in either direction.
std::ptrdiff_t count_of(const std::vector<Stroke>& strokes, const Vec2& a, const Vec2& b) {
  constexpr double same_mm = 0.01;
  const auto at = [](const Vec2& p, const Vec2& q) { return (p - q).norm() < same_mm; };
  return std::ranges::count_if(strokes, [&](const Stroke& stroke) {
    return (at(stroke.from_mm, a) && at(stroke.to_mm, b)) || (at(stroke.from_mm, b) && at(stroke.to_mm, a));
  });
}

/// The number in quotation marks after a word, from a position in the text on.
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

/// Each dot has the marker's position and size, on one sheet.
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

/// The PDF of one sheet, its lines, and the position of dot O on the paper; the sheet is centred.
class SheetInPdf : public testing::TestWithParam<const char*> {
 protected:
  static constexpr int id = 447;
  PaperSize paper = *paper_named(GetParam());
  std::vector<Stroke> strokes = strokes_in_pdf(pdf_text({draw_marker_sheet(id, paper)}));
  Vec2 o_mm{0.5 * paper.width_mm - 60.0, 0.5 * paper.height_mm - 60.0};
};
INSTANTIATE_TEST_SUITE_P(Papers, SheetInPdf, testing::Values("A4", "A3"));

TEST_P(SheetInPdf, has_a_ruler_of_ten_centimetres_with_a_tick_at_each) {
  EXPECT_EQ(count_of(strokes, o_mm + Vec2(0.0, -50.0), o_mm + Vec2(100.0, -50.0)), 1);
  for (int cm = 0; cm <= 10; ++cm) {
    const Vec2 foot = o_mm + Vec2(10.0 * cm, -50.0);
    EXPECT_EQ(count_of(strokes, foot, foot + Vec2(0.0, cm % 5 == 0 ? 6.0 : 3.0)), 1) << cm;
  }
}

TEST_P(SheetInPdf, has_cut_marks_at_the_corners_of_a_square_of_160_mm) {
  for (const double right : {-1.0, 1.0}) {
    for (const double top : {-1.0, 1.0}) {
      const Vec2 corner = o_mm + Vec2(60.0 + 80.0 * right, 60.0 + 80.0 * top);
      EXPECT_EQ(count_of(strokes, corner + Vec2(2.0 * right, 0.0), corner + Vec2(10.0 * right, 0.0)), 1);
      EXPECT_EQ(count_of(strokes, corner + Vec2(0.0, 2.0 * top), corner + Vec2(0.0, 10.0 * top)), 1);
    }
  }
}

TEST_P(SheetInPdf, has_an_arrow_from_o_to_x_that_points_to_x) {
  const Vec2 tip = o_mm + Vec2(120.0, -16.0);
  EXPECT_EQ(count_of(strokes, o_mm + Vec2(0.0, -16.0), tip), 1);
  EXPECT_EQ(count_of(strokes, tip, tip + Vec2(-4.0, 2.0)), 1);
  EXPECT_EQ(count_of(strokes, tip, tip + Vec2(-4.0, -2.0)), 1);
}

TEST_P(SheetInPdf, has_a_cross_to_drill_by_in_the_middle_of_each_dot) {
  for (const GridCell& cell : dots_of(id)) {
    const Vec2 middle = o_mm + 1000.0 * cell_in_marker(cell);
    EXPECT_EQ(count_of(strokes, middle - Vec2(3.0, 0.0), middle + Vec2(3.0, 0.0)), 1);
    EXPECT_EQ(count_of(strokes, middle - Vec2(0.0, 3.0), middle + Vec2(0.0, 3.0)), 1);
  }
}

TEST(MarkerSheet, of_a_site_says_where_its_marker_hangs_and_shows_it_on_a_plan) {
  OccupancyMap map{
      .columns = 60, .rows = 40, .resolution_m = 0.1, .map_from_grid = {{-1.0, 2.0}, 0.0}, .cells = {}};
  map.cells.assign(60 * 40, OccupancyMap::free);
  for (int row = 0; row < 40; ++row)
    map.cells[map.index({0, row})] = OccupancyMap::occupied;  // ends at x = -0.9
  MarkerRegistry registry;
  registry.markers.push_back({7, {0.94, 4.06, 2.6}, 0.0});  // O; the square's centre is at 1, 4
  const SheetPage page = PlaceSheets(map, "Hall (\xC3\x96st)", "2026-11-26", *paper_named("A4"))
                             .page(registry, registry.markers[0]);
  const std::string pdf = pdf_text({page});
  for (const char* words :
       {"(Hall \\(?st\\), 2026-11-26)", "(centre x 1.000 m, y 4.000 m)",
        "(2.600 m above the floor, face down)", "(arrow O to X at 0.0 degrees on the plan)",
        "(1.900 m from the wall on the left)"}) {
    EXPECT_THAT(pdf, HasSubstr(words));
  }
  // 6 x 4 m drawn 51 x 34 mm with its upper right corner 12 mm inside the page's; the cross is 2 m from the
  // left, half way up.
  const double mm_per_m_of_plan = 34.0 / 4.0;
  const Vec2 corner_mm(210.0 - 12.0 - 51.0, 297.0 - 12.0 - 34.0);
  const Vec2 at_mm = corner_mm + mm_per_m_of_plan * Vec2(2.0, 2.0);
  const std::vector<Stroke> strokes = strokes_in_pdf(pdf);
  EXPECT_EQ(count_of(strokes, at_mm - Vec2(4.0, 0.0), at_mm + Vec2(4.0, 0.0)), 1);
  EXPECT_EQ(count_of(strokes, at_mm - Vec2(0.0, 4.0), at_mm + Vec2(0.0, 4.0)), 1);
  int walls = 0;
  for (const Stroke& stroke : strokes)
    if (std::abs(stroke.width_mm - 0.5) < 1e-3 && std::abs(stroke.from_mm.x() - corner_mm.x()) < 0.01)
      ++walls;
  EXPECT_EQ(walls, 68) << "each half millimetre of the wall on the left";
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
