#include "app/report/figure.hpp"

#include <filesystem>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "app/common/picture_file.hpp"
#include "app/report/canvas.hpp"
#include "maps/input_error.hpp"

#include "tests/app/sample_run.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

/// Colour at a point of the sample's floor; the figure shows the whole map, 1800 pixels wide.
cv::Vec3b color_at(const cv::Mat& picture, const Vec2& point_m) {
  const Canvas canvas({0.0, 0.0}, {4.0, 2.0}, 1800.0, {});
  const Vec2 pixel = canvas.pixel(point_m);
  return picture.at<cv::Vec3b>(static_cast<int>(pixel.y()), static_cast<int>(pixel.x()));
}

bool is_orange(const cv::Vec3b& color) {
  return color[2] > 200 && color[1] > 90 && color[1] < 190 && color[0] < 60;
}
bool is_dark(const cv::Vec3b& color) {
  return color[0] < 80 && color[1] < 80 && color[2] < 80;
}
bool is_red(const cv::Vec3b& color) {
  return color[2] > 180 && color[1] < 120 && color[0] < 120;
}
bool is_gray(const cv::Vec3b& color) {
  return color[0] == color[1] && color[1] == color[2] && color[0] > 150 && color[0] < 240;
}
const cv::Vec3b white(255, 255, 255);

TEST(Figure, shows_floor_obstacles_and_unknown_in_their_colours) {
  const cv::Mat picture = draw_experiment(sample::run(), sample::floor(), sample::ceiling());
  EXPECT_EQ(picture.type(), CV_8UC3);
  EXPECT_NEAR(picture.cols, 1930, 100);
  EXPECT_TRUE(is_dark(color_at(picture, {0.25, 1.7})));
  EXPECT_EQ(color_at(picture, {1.0, 1.7}), white);
  EXPECT_TRUE(is_gray(color_at(picture, {3.75, 1.7})));
}

TEST(Figure, shows_the_marker_at_its_middle_with_a_stroke_to_its_x) {
  const cv::Mat picture = draw_experiment(sample::run(), sample::floor(), sample::ceiling());
  EXPECT_TRUE(is_orange(color_at(picture, {2.0, 1.5})));
  EXPECT_TRUE(is_orange(color_at(picture, {2.035, 1.5})));
  EXPECT_EQ(color_at(picture, {1.965, 1.5}), white);
}

TEST(Figure, shows_the_planned_curve_between_the_circles_of_the_track) {
  RunRecord record = sample::run();
  EXPECT_TRUE(is_red(color_at(draw_experiment(record, sample::floor(), {}), {1.75, 1.0})));
  for (GoalRecord& goal : record.goals) goal.planned = {};
  EXPECT_EQ(color_at(draw_experiment(record, sample::floor(), {}), {1.75, 1.0}), white);
}

TEST(Figure, shows_zones_ways_and_places) {
  const Places places{.places = {{"desk", {2.6, 0.4}, std::nullopt}},
                      .nodes = {{"N1", {1.2, 0.4}}},
                      .edges = {{.from = "N1", .to = "desk", .one_way = true, .max_mps = std::nullopt}},
                      .keep_out = {{"", {{0.8, 1.4}, {1.4, 1.4}, {1.4, 1.9}, {0.8, 1.9}}}},
                      .speed_zones = {{"", {{2.4, 1.2}, {2.8, 1.2}, {2.8, 1.9}, {2.4, 1.9}}, 0.2}}};
  const cv::Mat plain = draw_experiment(sample::run(), sample::floor(), {});
  const cv::Mat picture = draw_experiment(sample::run(), sample::floor(), {}, places);
  const auto differs = [&](const Vec2& at_m) { return color_at(plain, at_m) != color_at(picture, at_m); };
  EXPECT_TRUE(is_red(color_at(picture, {1.1, 1.4})));  // outline of the keep-out
  EXPECT_TRUE(differs({2.4, 1.7}));                    // of the speed zone
  EXPECT_FALSE(differs({2.45, 1.85}));                 // which is empty
  EXPECT_TRUE(differs({1.6, 0.4}));                    // the edge
  EXPECT_FALSE(differs({1.6, 0.42}));
  int hatched = 0;  // a stroke each 12 pixels of a line across the keep-out, 0.6 m of 450 pixels each
  for (double x_m = 0.82; x_m < 1.38; x_m += 1.0 / 450.0) hatched += differs({x_m, 1.65}) ? 1 : 0;
  EXPECT_GT(hatched, 20);
  EXPECT_LT(hatched, 120);
}

TEST(Figure, way_there_and_way_back_differ) {
  const auto differing = [](std::size_t goals) {
    RunRecord record = sample::run();
    record.goals.resize(goals);
    for (GoalRecord& goal : record.goals) goal.planned = {};
    for (std::size_t i = 5; i < record.truth.size(); ++i) record.truth[i].map_from_base.position_m.y() = 0.5;
    return draw_experiment(record, sample::floor(), {});
  };
  // The left edge of the circle around (2.0, 0.5): 5 pixels, at 450 pixels per metre.
  const Vec2 edge(2.0 - 5.0 / 450.0, 0.5);
  EXPECT_NE(color_at(differing(1), edge), white);
  EXPECT_NE(color_at(differing(1), edge), color_at(differing(2), edge));
}

TEST(Figure, map_that_lies_turned_is_drawn_turned) {
  OccupancyMap map = sample::floor();
  map.map_from_grid = {{2.0, 0.0}, radians(90.0)};  // now 2 m wide and 4 m high, its obstacle at the bottom
  const cv::Mat picture = draw_plan(map, {}, {1.0, 1.0}, {1.0, 2.0}, {});
  const Canvas canvas({0.0, 0.0}, {2.0, 4.0}, 1800.0, {});
  const auto color = [&](const Vec2& point_m) {
    const Vec2 pixel = canvas.pixel(point_m);
    return picture.at<cv::Vec3b>(static_cast<int>(pixel.y()), static_cast<int>(pixel.x()));
  };
  EXPECT_TRUE(is_dark(color({1.0, 0.25})));
  EXPECT_EQ(color({0.25, 2.0}), white);
  EXPECT_TRUE(is_gray(color({1.0, 3.75})));
}

TEST(Figure, plan_may_be_empty) {
  const cv::Mat picture = draw_plan(sample::floor(), sample::ceiling(), {1.0, 1.0}, {3.0, 1.0}, {});
  EXPECT_EQ(color_at(picture, {2.0, 1.0}), white);
}

TEST(Figure, is_read_back_from_its_file_as_it_was) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "figure.png";
  const cv::Mat picture = draw_plan(sample::floor(), {}, {1.0, 1.0}, {3.0, 1.0}, {});
  write_png(file, picture);
  const cv::Mat again = cv::imread(file.string(), cv::IMREAD_COLOR);
  ASSERT_EQ(again.size(), picture.size());
  EXPECT_EQ(cv::norm(again, picture, cv::NORM_INF), 0.0);
}

TEST(Figure, that_cannot_be_written_is_an_input_error) {
  EXPECT_THROW(write_png("no/such/folder/figure.png", cv::Mat(2, 2, CV_8UC3, cv::Scalar::all(0))),
               InputError);
}

}  // namespace
}  // namespace lodestar
