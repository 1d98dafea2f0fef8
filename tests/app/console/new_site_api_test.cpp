#include "app/console/new_site_api.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "app/common/base64.hpp"
#include "app/site/site.hpp"
#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

// The documents of the page that makes a site, without a network.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class NewSiteApiTest : public testing::Test {
 protected:
  HttpResponse put(const std::string& what, const json& sent) {
    return api_.answer({.method = "PUT", .target = "/api/new/" + what, .body = sent.dump()});
  }
  json done(const std::string& what, const json& sent) {
    const HttpResponse response = put(what, sent);
    EXPECT_EQ(response.status, 200) << response.body;
    return json::parse(response.body);
  }
  json site_of(const json& map) {
    return {{"map", map},      {"base", "agilex"},       {"camera", "wide"},
            {"radius_m", 0.3}, {"camera_height_m", 0.9}, {"ceiling_m", 2.7},
            {"fill", true}};
  }

  TemporaryFolder folder_;
  fs::path site_ = folder_ / "hall";
  NewSiteApi api_{site_, fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", site_.parent_path() / "runs"};
};

/// A room of 6 x 4 m inside walls of 10 cm, at 50 pixels a metre, with paper around it.
std::string plan_png() {
  cv::Mat paper(260, 360, CV_8U, cv::Scalar(255));
  cv::rectangle(paper, cv::Rect(20, 20, 310, 210), cv::Scalar(0), cv::FILLED);
  cv::rectangle(paper, cv::Rect(25, 25, 300, 200), cv::Scalar(255), cv::FILLED);
  std::vector<unsigned char> bytes;
  cv::imencode(".png", paper, bytes);
  return {bytes.begin(), bytes.end()};
}

TEST_F(NewSiteApiTest, makes_a_site_of_a_plan_with_markers_wherever_its_robot_needs_them) {
  EXPECT_EQ(json::parse(api_.answer({.method = "GET", .target = "/api/site"}).body),
            json({{"new", true}, {"folder", "hall"}}));
  const json plan =
      done("plan", {{"name", "Plan.PNG"}, {"bytes", base64(plan_png())}, {"metres_per_unit", nullptr}});
  EXPECT_EQ(plan["width_px"], 360);
  EXPECT_TRUE(plan["metres_per_px"].is_null());
  EXPECT_TRUE(from_base64(plan["png"].get<std::string>())->starts_with("\x89PNG"));

  const json made =
      done("map", {{"metres_per_px", 0.02}, {"rotate_deg", 0}, {"threshold", 128}, {"cell_m", 0.05}});
  EXPECT_EQ(made["warnings"], json::array());
  EXPECT_NEAR(made["map"]["columns"].get<double>() * 0.05, 6.2, 0.11);
  EXPECT_FALSE(fs::exists(site_));

  json map = made["map"];
  std::string cells = *from_base64(map["cells"].get<std::string>());
  const int columns = map["columns"];
  cells[static_cast<std::size_t>(40 * columns + 60)] = 100;  // a pillar that somebody draws
  map["cells"] = base64(cells);
  const json site = done("site", site_of(map));
  EXPECT_GT(site["markers"], 4);
  EXPECT_TRUE(api_.is_made());
  const Site read = load_site(site_);
  EXPECT_EQ(read.map.map.at({60, 40}), OccupancyMap::occupied);
  EXPECT_EQ(read.registry.markers.size(), site["markers"]);
  EXPECT_EQ(read.robot.radius_m, 0.3);
  EXPECT_EQ(read.robot.base_from_camera.translation().z(), 0.9);
  EXPECT_EQ(put("site", site_of(map)).status, 422);
}

TEST_F(NewSiteApiTest, says_what_is_wrong_and_writes_nothing) {
  const json hall = done("map", {{"hall_m", {5.0, 4.0}}, {"cell_m", 0.05}})["map"];
  json short_of_cells = hall;
  short_of_cells["cells"] = base64("abc");
  json odd_cell = hall;
  odd_cell["cells"] = base64(
      std::string(static_cast<std::size_t>(hall["columns"]) * hall["rows"].get<std::size_t>(), '\x07'));
  json low = site_of(hall);
  low["camera_height_m"] = 2.5;
  json of_nobody = site_of(hall);
  of_nobody["base"] = "horse";
  json without_room = site_of(hall);
  without_room["radius_m"] = 5.0;
  for (const auto& [what, sent, words] : std::vector<std::tuple<std::string, json, std::string>>{
           {"plan",
            {{"name", "a.png"}, {"bytes", "%%%%"}, {"metres_per_unit", nullptr}},
            "bytes: found no base64"},
           {"plan",
            {{"name", "a.png"}, {"bytes", "AAAA"}, {"metres_per_unit", nullptr}},
            "a.png: found no picture"},
           {"plan",
            {{"name", "../a.exe"}, {"bytes", "AAAA"}, {"metres_per_unit", nullptr}},
            "ends in '.exe'"},
           {"map", {{"metres_per_px", 0.02}, {"cell_m", 0.05}}, "found no plan"},
           {"map", {{"runs", {"../../etc"}}, {"cell_m", 0.05}}, "wanted names of /api/new/runs"},
           {"map", {{"runs", json::array()}, {"cell_m", 0.05}}, "wanted names of /api/new/runs"},
           {"map", {{"hall_m", {0.1, 0.1}}, {"cell_m", 0.05}}, "wanted a square metre"},
           {"site", site_of(short_of_cells), "cells: found 3, wanted"},
           {"site", site_of(odd_cell), "cells: found 7, wanted 0, 100 or 255"},
           {"site", low, "ceiling_m: found 2.7, wanted at least 0.3 m above"},
           {"site", of_nobody, "base: found 'horse', wanted agilex or odrive"},
           {"site", without_room, "room"},
           {"other", json::object(), "found no such document"}}) {
    const HttpResponse response = put(what, sent);
    EXPECT_EQ(response.status, 422) << what;
    EXPECT_THAT(response.body, HasSubstr(words));
  }
  EXPECT_FALSE(fs::exists(site_));
  EXPECT_EQ(api_.answer({.method = "POST", .target = "/api/new/site"}).status, 405);
}

TEST_F(NewSiteApiTest, takes_no_name_that_is_there) {
  std::ofstream(site_) << "something";
  EXPECT_THROW(NewSiteApi(site_, fs::path(LODESTAR_SOURCE_DIR) / "sites/lab", ""), InputError);
}

TEST(Base64, is_read_back_and_nothing_else_is) {
  for (const std::string bytes : {"", "a", "ab", "abc", "abcd", "\xff\x01\x80"})
    EXPECT_EQ(from_base64(base64(bytes)), bytes);
  for (const char* wrong : {"a", "ab", "abc", "a===", "ab=c", "ab c", "!!!!"})
    EXPECT_FALSE(from_base64(wrong)) << wrong;
}

}  // namespace
}  // namespace lodestar
