#include "app/site/new_site.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/site/floor_plan.hpp"
#include "app/site/site.hpp"
#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The outer walls of a room, on white paper.
cv::Mat room_on_paper(cv::Size paper, cv::Rect walls) {
  cv::Mat picture(paper, CV_8U, cv::Scalar(255));
  cv::rectangle(picture, walls, cv::Scalar(40), 1);
  return picture;
}

int count(const OccupancyMap& map, std::int8_t value) {
  return static_cast<int>(std::ranges::count(map.cells, value));
}

double width_m(const OccupancyMap& map) {
  return map.columns * map.resolution_m;
}

std::string message_of(const fs::path& plan, const PlanOptions& options) {
  try {
    (void)map_from_plan(plan, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// A rectangle 8 x 4 units, and a wall across it on a frozen layer.
std::string dxf_room(int insunits, double side) {
  std::string text = fmt::format("0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{}\n0\nENDSEC\n", insunits);
  text +=
      "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n2\n0\nLAYER\n2\nWALLS\n70\n0\n62\n7\n6\nCONTINUOUS\n"
      "0\nLAYER\n2\nOLD\n70\n1\n62\n7\n6\nCONTINUOUS\n0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  const auto line = [&](const char* layer, double x1, double y1, double x2, double y2) {
    text += fmt::format("0\nLINE\n8\n{}\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", layer, x1 * side, y1 * side,
                        x2 * side, y2 * side);
  };
  line("WALLS", 0, 0, 8, 0);
  line("WALLS", 8, 0, 8, 4);
  line("WALLS", 8, 4, 0, 4);
  line("WALLS", 0, 4, 0, 0);
  line("OLD", 4, 0, 4, 4);
  return text + "0\nENDSEC\n0\nEOF\n";
}

/// One page of 200 x 100 mm with the outline of a room of 160 x 80 mm, 2 mm thick.
std::string pdf_room() {
  const std::string drawn = "2.8346 0 0 2.8346 0 0 cm 2 w 20 10 160 80 re S\n";
  std::string text = "%PDF-1.4\n";
  std::vector<std::size_t> places;
  for (const std::string& object :
       {std::string("<< /Type /Catalog /Pages 2 0 R >>"),
        std::string("<< /Type /Pages /Count 1 /Kids [3 0 R] >>"),
        std::string("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 566.93 283.46] /Contents 4 0 R >>"),
        fmt::format("<< /Length {} >>\nstream\n{}endstream", drawn.size(), drawn)}) {
    places.push_back(text.size());
    text += fmt::format("{} 0 obj\n{}\nendobj\n", places.size(), object);
  }
  const std::size_t table = text.size();
  text += "xref\n0 5\n0000000000 65535 f \n";
  for (const std::size_t place : places) text += fmt::format("{:010} 00000 n \n", place);
  return text + fmt::format("trailer\n<< /Size 5 /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n", table);
}

TEST(MapFromPlan, keeps_thin_walls_ends_at_them_and_knows_what_is_outside) {
  const TemporaryFolder folder;
  // 10 mm pixels: walls of 10 mm in cells of 50 mm, 8 x 4 m apart, and a smaller room inside.
  cv::Mat picture = room_on_paper({1000, 600}, {50, 50, 801, 401});
  cv::rectangle(picture, cv::Rect(50, 50, 400, 200), cv::Scalar(40), 1);
  cv::imwrite((folder / "plan.png").string(), picture);
  const MapFromPlan planned = map_from_plan(folder / "plan.png", {.metres_per_unit = 0.01});
  EXPECT_TRUE(planned.warnings.empty());
  EXPECT_NEAR(width_m(planned.map), 8.0, 0.11);
  EXPECT_NEAR(planned.map.rows * planned.map.resolution_m, 4.0, 0.11);
  EXPECT_EQ(count(planned.map, OccupancyMap::unknown), 0);
  // The inner room's walls are whole: a cell in each row of its right side is occupied.
  const int column = static_cast<int>(4.0 / 0.05);
  for (int row = 45; row < 75; ++row) {
    const bool is_closed = planned.map.at({column - 1, row}) == OccupancyMap::occupied ||
                           planned.map.at({column, row}) == OccupancyMap::occupied;
    EXPECT_TRUE(is_closed) << row;
  }
}

TEST(MapFromPlan, turned_by_45_degrees_has_no_hole_in_a_wall_of_one_pixel) {
  const PlanPicture picture{.walls = room_on_paper({500, 300}, {50, 50, 401, 201}), .metres_per_px = 0.02};
  cv::Mat walls;
  cv::compare(picture.walls, 128, walls, cv::CMP_GE);
  const MapFromPlan turned =
      map_from_picture({walls, picture.metres_per_px}, {.rotate_rad = 0.25 * std::numbers::pi});
  EXPECT_TRUE(turned.warnings.empty());  // a hole would let the outside in
  const double free_m2 = count(turned.map, OccupancyMap::free) * 0.05 * 0.05;
  EXPECT_NEAR(free_m2, 8.0 * 4.0, 2.0);
  EXPECT_NEAR(width_m(turned.map), (8.0 + 4.0) * std::numbers::sqrt2 / 2.0, 0.2);
}

TEST(MapFromPlan, warns_of_open_walls_and_refuses_what_has_no_scale_or_no_walls) {
  const TemporaryFolder folder;
  cv::Mat picture = room_on_paper({400, 300}, {50, 50, 301, 201});
  cv::line(picture, {100, 50}, {150, 50}, cv::Scalar(255));
  cv::imwrite((folder / "open.png").string(), picture);
  const MapFromPlan open = map_from_plan(folder / "open.png", {.metres_per_unit = 0.02});
  ASSERT_EQ(open.warnings.size(), 1U);
  EXPECT_THAT(open.warnings.front(), HasSubstr("open to the outside"));

  EXPECT_THAT(message_of(folder / "open.png", {}), HasSubstr("400 x 300 pixels without a scale"));
  EXPECT_THAT(message_of(folder / "open.png", {.metres_per_unit = 0.02, .darkest_free = 10}),
              HasSubstr("nothing dark enough"));
  EXPECT_THAT(message_of(folder / "none.png", {}), HasSubstr("no file"));
  folder.write("torn.png", "not a picture");
  EXPECT_THAT(message_of(folder / "torn.png", {}), HasSubstr("no picture that can be read"));
}

TEST(MapFromPlan, reads_the_units_of_a_dxf_and_asks_where_it_has_none) {
  const TemporaryFolder folder;
  folder.write("mm.dxf", dxf_room(4, 1000.0));
  folder.write("feet.dxf", dxf_room(2, 1.0));
  folder.write("none.dxf", dxf_room(0, 1.0));
  folder.write("far.dxf", dxf_room(6, 1e7));
  const OccupancyMap mm = map_from_plan(folder / "mm.dxf", {}).map;
  EXPECT_NEAR(width_m(mm), 8.0, 0.11);
  // The frozen layer's wall across the middle is not there.
  EXPECT_EQ(mm.at({mm.columns / 2, mm.rows / 2}), OccupancyMap::free);
  EXPECT_NEAR(width_m(map_from_plan(folder / "feet.dxf", {}).map), 8.0 * 0.3048, 0.11);
  EXPECT_NEAR(width_m(map_from_plan(folder / "none.dxf", {.metres_per_unit = 2.0}).map), 16.0, 0.11);
  EXPECT_THAT(message_of(folder / "none.dxf", {}), HasSubstr("$INSUNITS"));
  EXPECT_THAT(message_of(folder / "far.dxf", {}), HasSubstr("coordinates so large"));
}

TEST(MapFromPlan, draws_the_first_page_of_a_pdf_at_150_pixels_per_inch) {
  const TemporaryFolder folder;
  folder.write("plan.pdf", pdf_room());
  folder.write("torn.pdf", "%PDF-1.4\nnothing");
  const double metres_per_px = 50.0 * 0.0254 / 150.0;  // 1:50
  const OccupancyMap map = map_from_plan(folder / "plan.pdf", {.metres_per_unit = metres_per_px}).map;
  EXPECT_NEAR(width_m(map), 8.1, 0.11);  // 160 mm and the line's width of 2 mm
  EXPECT_THAT(message_of(folder / "torn.pdf", {.metres_per_unit = 0.01}), HasSubstr("wanted a PDF file"));
}

class NewSiteFolder : public testing::Test {
 protected:
  [[nodiscard]] static NewSite hall() {
    const fs::path lab = fs::path(LODESTAR_SOURCE_DIR) / "sites/lab";
    return {.map = empty_hall(6.0, 4.0, 0.05),
            .robot_file = lab / "robot.yaml",
            .camera_file = lab / "camera.yaml",
            .camera_profile = "wide",
            .base_protocol = "odrive"};
  }
  TemporaryFolder folder_;
};

TEST_F(NewSiteFolder, is_complete_and_reads_back) {
  make_site(hall(), folder_ / "hall");
  const Site site = load_site(folder_ / "hall");
  EXPECT_EQ(site.name, "hall");
  EXPECT_TRUE(site.registry.markers.empty());
  EXPECT_TRUE(fs::exists(folder_ / "hall" / "places.yaml"));
  EXPECT_EQ(site.base->protocol, "odrive");
  EXPECT_NEAR(site.start.position_m.x(), 3.0, 1.05);  // the ridge with 2 m of room on all sides
  EXPECT_NEAR(site.start.position_m.y(), 2.0, 0.06);
  EXPECT_GT((site.goals.front().position_m - site.start.position_m).norm(), 2.0);
}

TEST_F(NewSiteFolder, never_replaces_and_leaves_nothing_of_a_failure) {
  folder_.write("taken", "a file");
  EXPECT_THROW(make_site(hall(), folder_ / "taken"), InputError);
  EXPECT_EQ(folder_.read("taken"), "a file");
  NewSite narrow = hall();
  narrow.map = empty_hall(6.0, 0.4, 0.05);
  EXPECT_THROW(make_site(narrow, folder_ / "narrow"), InputError);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace lodestar
