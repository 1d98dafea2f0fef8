#include "localization/detection/marker_detector.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>

#include "tests/localization/detection/detector_frames.hpp"

namespace lodestar {
namespace {

using testing::ElementsAre;

TEST(MarkerDetector, reads_every_id_at_any_turn) {
  Random random(1);
  const CameraModel camera = cropped(wide_camera(), 64);
  for (int id = 0; id < marker_id_count; ++id) {
    PaintedFrame frame(size_of(camera));
    frame.marker(camera, {.middle_px = {31.3, 32.2}, .turn_rad = radians(random.uniform(0.0, 360.0))}, id);
    ASSERT_THAT(ids_in(frame.finished(random)), ElementsAre(id));
  }
}

struct Conditions {
  std::string name;
  CameraModel camera;
  double depth_m = 1.5;
  double dot_gray = 246.0;
  double tilt_deg = 0.0;
  double motion_px = 0.0;
  double center_sigma_px = 0.02;  ///< required, per coordinate
};

class UnderConditions : public testing::TestWithParam<Conditions> {};

TEST_P(UnderConditions, markers_are_read_and_their_dots_located) {
  const Conditions& conditions = GetParam();
  const CameraModel camera = cropped(conditions.camera, 140);
  Random random(2);
  const int frames = 60;
  int read = 0;
  int dots = 0;
  double squared_error = 0.0;
  for (int i = 0; i < frames; ++i) {
    const MarkerView view{.middle_px = {random.uniform(60.0, 80.0), random.uniform(60.0, 80.0)},
                          .depth_m = conditions.depth_m,
                          .turn_rad = radians(random.uniform(0.0, 360.0)),
                          .tilt_rad = radians(conditions.tilt_deg),
                          .tilt_axis_rad = radians(random.uniform(0.0, 360.0))};
    const int id = random_id(random) | 0x090;  // five dots at least: fewer are refused when tilted
    PaintedFrame frame(size_of(camera));
    frame.marker(camera, view, id, conditions.dot_gray);
    if (conditions.motion_px > 0.0) {
      const double direction = radians(random.uniform(0.0, 360.0));
      frame.move(conditions.motion_px * Vec2(std::cos(direction), std::sin(direction)));
    }
    const std::vector<DetectedMarker> markers = detect_markers(frame.finished(random));
    if (markers.empty()) continue;
    ++read;
    ASSERT_EQ(markers.size(), 1U);
    ASSERT_EQ(markers.front().id, id);
    for (const MarkerDot& dot : markers.front().dots) {
      const Vec2 error = dot.center_px - dot_in_image(camera, view, dot.cell);
      EXPECT_LT(error.norm(), 6.0 * conditions.center_sigma_px);
      squared_error += error.squaredNorm();
      ++dots;
    }
    EXPECT_LT((markers.front().o_px - dot_in_image(camera, view, cell_of_o)).norm(), 0.15);
    EXPECT_LT((markers.front().x_px - dot_in_image(camera, view, cell_of_x)).norm(), 0.15);
    EXPECT_LT((markers.front().y_px - dot_in_image(camera, view, cell_of_y)).norm(), 0.15);
  }
  EXPECT_GE(read, frames - 1);
  EXPECT_LT(std::sqrt(0.5 * squared_error / dots), conditions.center_sigma_px);
}

INSTANTIATE_TEST_SUITE_P(
    cameras, UnderConditions,
    testing::Values(
        Conditions{.name = "paper_near", .camera = paper_camera(), .depth_m = 1.5, .center_sigma_px = 0.012},
        Conditions{
            .name = "paper_table_3", .camera = paper_camera(), .depth_m = 2.6, .center_sigma_px = 0.015},
        Conditions{.name = "paper_far", .camera = paper_camera(), .depth_m = 3.0, .center_sigma_px = 0.016},
        Conditions{.name = "wide", .camera = wide_camera(), .center_sigma_px = 0.018},
        Conditions{.name = "paper_faint", .camera = paper_camera(), .depth_m = 2.6, .dot_gray = 216.0},
        Conditions{.name = "paper_bright", .camera = paper_camera(), .depth_m = 2.6, .dot_gray = 280.0},
        Conditions{
            .name = "wide_faint", .camera = wide_camera(), .dot_gray = 225.0, .center_sigma_px = 0.025},
        Conditions{.name = "wide_bright", .camera = wide_camera(), .dot_gray = 255.0},
        Conditions{.name = "paper_tilted", .camera = paper_camera(), .depth_m = 1.5, .tilt_deg = 25.0},
        Conditions{.name = "wide_tilted", .camera = wide_camera(), .tilt_deg = 25.0},
        Conditions{.name = "paper_moving", .camera = paper_camera(), .depth_m = 2.6, .motion_px = 2.0},
        Conditions{.name = "wide_moving", .camera = wide_camera(), .motion_px = 1.5}),
    [](const auto& parameter) { return parameter.param.name; });

// Markers off the axis of a 90 degree view with the camera tilted by 15 degrees: foreshortened by more than
// that.
TEST(MarkerDetector, reads_markers_about_a_tilted_wide_frame) {
  Random random(3);
  const CameraModel camera = wide_camera();
  for (const Vec2& place : {Vec2(200.0, 160.0), Vec2(440.0, 160.0), Vec2(200.0, 320.0), Vec2(440.0, 320.0)}) {
    PaintedFrame frame(size_of(camera));
    const MarkerView view{
        .middle_px = place, .turn_rad = radians(random.uniform(0.0, 360.0)), .tilt_rad = radians(15.0)};
    frame.marker(camera, view, 1782);
    EXPECT_THAT(ids_in(frame.finished(random)), ElementsAre(1782));
  }
}

TEST(MarkerDetector, confidence_in_ordinary_light_is_that_of_the_papers_tables) {
  Random random(4);
  const CameraModel camera = cropped(paper_camera(), 100);
  PaintedFrame frame(size_of(camera));
  frame.marker(camera, {.middle_px = {50.0, 50.0}, .depth_m = 2.6}, 1782);
  const std::vector<DetectedMarker> markers = detect_markers(frame.finished(random));
  ASSERT_EQ(markers.size(), 1U);
  EXPECT_GT(markers.front().confidence, 0.84);
  EXPECT_LT(markers.front().confidence, 0.95);
}

/// Three markers among a tube, a round lamp, a small lamp and glints of all sizes.
TEST(MarkerDetector, ignores_tubes_lamps_and_glints_and_ranks_by_distance_to_the_center) {
  Random random(5);
  const CameraModel camera = wide_camera();
  for (int i = 0; i < 20; ++i) {
    PaintedFrame frame(size_of(camera));
    const double turn = radians(random.uniform(0.0, 360.0));
    frame.marker(camera, {.middle_px = {120.0, 110.0}, .turn_rad = turn}, 3003);
    frame.marker(camera, {.middle_px = {300.0, 260.0}, .turn_rad = 2.0 * turn}, 1782);
    frame.marker(camera, {.middle_px = {480.0, 330.0}, .turn_rad = 3.0 * turn}, 0);
    frame.tube({200.0, 40.0}, {420.0, 60.0}, 14.0);
    frame.tube({30.0, 250.0}, {110.0, 420.0}, 4.0);
    frame.tube({560.0, 100.0}, {563.0, 112.0}, 3.0);
    frame.disc({400.0, 150.0}, 18.0);
    frame.disc({250.0, 400.0}, 7.0);
    for (const double radius : {0.6, 1.0, 1.6, 2.1, 2.1, 2.1, 3.0}) {
      frame.disc({random.uniform(520.0, 630.0), random.uniform(150.0, 240.0)}, radius);
    }
    EXPECT_THAT(ids_in(frame.finished(random)), ElementsAre(1782, 0, 3003));
  }
}

TEST(MarkerDetector, keeps_markers_30_cm_apart_apart) {
  Random random(6);
  const CameraModel camera = wide_camera();
  const double apart_px = 0.30 * camera.fx_px / 1.5;
  for (int i = 0; i < 20; ++i) {
    PaintedFrame frame(size_of(camera));
    const double turn = radians(random.uniform(0.0, 360.0));
    frame.marker(camera, {.middle_px = {320.0, 240.0}, .turn_rad = turn}, 0xfff);
    frame.marker(camera, {.middle_px = {320.0 + apart_px, 240.0}, .turn_rad = -turn}, 0);
    frame.marker(camera, {.middle_px = {320.0, 238.0 - apart_px}}, 447);
    EXPECT_THAT(ids_in(frame.finished(random)), testing::UnorderedElementsAre(0xfff, 0, 447));
  }
}

// Field of view of 90 degrees, ceiling 2.6 m above: a dot radius of 1.23 px, dimmed by blur, at a pitch of 5
// px.
TEST(MarkerDetector, reads_dots_of_little_more_than_a_pixel_through_blur) {
  Random random(15);
  const CameraModel camera = cropped(wide_camera(), 80);
  constexpr int frames = 100;
  int read = 0;
  for (int i = 0; i < frames; ++i) {
    const int id = random_id(random) | 0x090;
    const MarkerView view{.middle_px = {random.uniform(35.0, 45.0), random.uniform(35.0, 45.0)},
                          .depth_m = 2.6,
                          .turn_rad = radians(random.uniform(0.0, 360.0))};
    PaintedFrame frame(size_of(camera));
    frame.marker(camera, view, id);
    const std::vector<DetectedMarker> markers =
        detect_markers(frame.finished(random, 4.0, 0.8), {.registered_ids = {id, id ^ 0x907}});
    for (const DetectedMarker& marker : markers) EXPECT_EQ(marker.id, id);
    read += static_cast<int>(markers.size());
  }
  EXPECT_GE(read, 85);
}

TEST(MarkerDetector, parts_dots_that_touch_in_too_bright_a_light) {
  Random random(11);
  const CameraModel camera = cropped(paper_camera(), 160);
  const MarkerView view{.middle_px = {80.0, 80.0}, .depth_m = 1.5};
  PaintedFrame frame(size_of(camera));
  frame.marker(camera, view, 1782);
  cv::Mat gray = frame.finished(random, 1.0);
  // A bridge of one bright pixel's width between two neighbouring dots.
  const Vec2 from = dot_in_image(camera, view, {0, 1});
  const Vec2 to = dot_in_image(camera, view, {0, 2});
  cv::line(gray, cv::Point(cvRound(from.x()), cvRound(from.y())), cv::Point(cvRound(to.x()), cvRound(to.y())),
           cv::Scalar(225), 1);
  DotFinder finder;
  const std::span<const Dot> dots = finder.find(gray);
  EXPECT_EQ(dots.size(), dots_of(1782).size());
}

TEST(MarkerDetector, reads_a_part_of_a_larger_frame_as_that_part) {
  Random random(12);
  const CameraModel camera = wide_camera();
  PaintedFrame painted(size_of(camera));
  painted.marker(camera, {.middle_px = {200.0, 150.0}}, 1782);
  painted.marker(camera, {.middle_px = {500.0, 400.0}}, 447);
  const cv::Mat frame = painted.finished(random);
  const cv::Mat part = frame(cv::Rect(101, 77, 190, 150));
  ASSERT_FALSE(part.isContinuous());
  const std::vector<DetectedMarker> markers = detect_markers(part);
  ASSERT_EQ(markers.size(), 1U);
  EXPECT_EQ(markers.front().id, 1782);
  EXPECT_LT((markers.front().o_px + Vec2(101.0, 77.0) -
             dot_in_image(camera, {.middle_px = {200.0, 150.0}}, cell_of_o))
                .norm(),
            0.1);
}

}  // namespace
}  // namespace lodestar
