#include "localization/detection/marker_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdexcept>
#include <string>

#include "tests/localization/painted_frame.hpp"

namespace lodestar {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<int> ids_in(const cv::Mat& frame) {
  std::vector<int> result;
  for (const DetectedMarker& marker : detect_markers(frame)) result.push_back(marker.id);
  return result;
}

/// The middle part of a camera's frame, which is quicker to draw.
CameraModel cropped(CameraModel camera, int side_px) {
  camera.cx_px += 0.5 * (side_px - camera.width_px);
  camera.cy_px += 0.5 * (side_px - camera.height_px);
  camera.width_px = side_px;
  camera.height_px = side_px;
  return camera;
}

cv::Size size_of(const CameraModel& camera) {
  return {camera.width_px, camera.height_px};
}

int random_id(Random& random) {
  return static_cast<int>(random.below(marker_id_count));
}

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
  double center_sigma_px = 0.02;  ///< wanted, for each coordinate
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

// Markers off the axis of a 90 degree view, the camera tilted by 15 degrees: foreshortened by more than that.
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

// The marker slides out of the frame; while any of its coded cells, even an empty one, may be cut, it is
// refused.
TEST(MarkerDetector, refuses_a_marker_that_the_border_cuts) {
  Random random(7);
  const CameraModel camera = cropped(wide_camera(), 80);
  int read = 0;
  for (double u = 40.0; u > -20.0; u -= 0.5) {
    const MarkerView view{.middle_px = {u, 40.0}, .turn_rad = radians(random.uniform(0.0, 360.0))};
    const int id = random_id(random);
    PaintedFrame frame(size_of(camera));
    frame.marker(camera, view, id);
    const std::vector<int> found = ids_in(frame.finished(random));
    double least_u = camera.width_px;
    for (int row = 0; row < marker_grid_size; ++row) {
      for (int column = 0; column < marker_grid_size; ++column) {
        if (id_bit({row, column}) == 0) continue;
        least_u = std::min(least_u, dot_in_image(camera, view, {row, column}).x());
      }
    }
    EXPECT_TRUE(found.empty() || found == std::vector{id}) << "u " << u;
    EXPECT_FALSE(least_u > 12.0 && found.empty()) << "u " << u;
    EXPECT_FALSE(least_u < 1.0 && !found.empty()) << "u " << u;
    read += found.empty() ? 0 : 1;
  }
  EXPECT_GT(read, 35);
}

TEST(MarkerDetector, refuses_a_marker_that_lacks_a_direction_dot) {
  Random random(8);
  const CameraModel camera = cropped(paper_camera(), 120);
  for (int i = 0; i < 60; ++i) {
    const MarkerView view{
        .middle_px = {60.0, 60.0}, .depth_m = 2.6, .turn_rad = radians(random.uniform(0.0, 360.0))};
    const std::array<GridCell, 3> direction{cell_of_o, cell_of_x, cell_of_y};
    PaintedFrame frame(size_of(camera));
    for (const GridCell cell : dots_of(random_id(random))) {
      if (cell != direction[static_cast<std::size_t>(i % 3)]) frame.dot(camera, view, cell, 246.0);
    }
    EXPECT_THAT(ids_in(frame.finished(random)), IsEmpty());
  }
}

// 90 degrees of view and a ceiling 2.6 m above: a radius of 1.23 px, dimmed by blur, five pixels to the next.
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

// Something as gray as the ceiling hides dots: what is left is another ID's pattern, but nobody's who is
// here.
TEST(MarkerDetector, refuses_ids_that_are_not_registered) {
  Random random(16);
  const CameraModel camera = cropped(paper_camera(), 120);
  PaintedFrame frame(size_of(camera));
  frame.marker(camera, {.middle_px = {60.0, 60.0}, .depth_m = 2.6, .turn_rad = 0.3}, 1542);
  const cv::Mat gray = frame.finished(random);
  EXPECT_THAT(ids_in(gray), ElementsAre(1542));
  EXPECT_THAT(detect_markers(gray, {.registered_ids = {447, 1782}}), IsEmpty());
}

/// A marker of which something as gray as the ceiling hides the dot of a cell, but for a sliver.
cv::Mat with_a_sliver(const CameraModel& camera, int id, GridCell hidden, Random& random) {
  const MarkerView view{.middle_px = {60.0, 60.0}, .depth_m = 2.6, .turn_rad = 0.3};
  const double radius_px = marker_dot_radius_m * camera.fx_px / view.depth_m;
  PaintedFrame frame(size_of(camera));
  frame.marker(camera, view, id);
  frame.disc(dot_in_image(camera, view, hidden) + Vec2(0.7 * radius_px, 0.0), 1.3 * radius_px, 35.0);
  return frame.finished(random);
}

// What is left of a covered dot says that something hangs before the marker, which may hide all of another.
TEST(MarkerDetector, doubts_an_id_where_slivers_tell_of_a_cover) {
  Random random(17);
  const CameraModel camera = cropped(paper_camera(), 120);
  constexpr int id = 1782;
  constexpr int without_a_dot = id & ~0x010;
  const cv::Mat covered = with_a_sliver(camera, id, {1, 1}, random);
  EXPECT_THAT(detect_markers(covered, {.registered_ids = {id, without_a_dot}}), IsEmpty());
  PaintedFrame clear(size_of(camera));
  clear.marker(camera, {.middle_px = {60.0, 60.0}, .depth_m = 2.6, .turn_rad = 0.3}, without_a_dot);
  const std::vector<DetectedMarker> markers =
      detect_markers(clear.finished(random), {.registered_ids = {id, without_a_dot}});
  ASSERT_EQ(markers.size(), 1U);
  EXPECT_EQ(markers.front().id, without_a_dot);
}

// Of a marker tilted more than is read some dots may stand as another's all do, seen less tilted and turned,
// were it not for the dots left over beside them.
TEST(MarkerDetector, never_reads_a_marker_into_a_part_of_a_steeply_tilted_one) {
  Random random(18);
  const CameraModel camera = cropped(paper_camera(), 120);
  for (int i = 0; i < 300; ++i) {
    const int id = random_id(random);
    const MarkerView view{.middle_px = {60.0, 60.0},
                          .depth_m = 2.0,
                          .turn_rad = radians(random.uniform(0.0, 360.0)),
                          .tilt_rad = radians(random.uniform(30.0, 55.0)),
                          .tilt_axis_rad = radians(random.uniform(0.0, 360.0))};
    PaintedFrame frame(size_of(camera));
    frame.marker(camera, view, id);
    EXPECT_THAT(ids_in(frame.finished(random)), testing::AnyOf(IsEmpty(), ElementsAre(id))) << "frame " << i;
  }
}

// A dirty dot that is taken for an empty cell would change the ID: it counts, or the marker is refused.
TEST(MarkerDetector, never_takes_a_dirty_dot_for_an_empty_cell) {
  Random random(9);
  const CameraModel camera = cropped(paper_camera(), 120);
  for (double gray = 70.0; gray <= 240.0; gray += 10.0) {
    const MarkerView view{.middle_px = {60.0, 60.0}, .depth_m = 2.6, .turn_rad = 0.3};
    PaintedFrame frame(size_of(camera));
    frame.marker(camera, view, 1782);
    frame.dot(camera, view, {1, 1}, gray);
    EXPECT_THAT(ids_in(frame.finished(random)), testing::AnyOf(IsEmpty(), ElementsAre(1782))) << gray;
  }
}

TEST(MarkerDetector, refuses_a_marker_whose_dot_a_lamp_swallows) {
  Random random(10);
  const CameraModel camera = cropped(paper_camera(), 140);
  const MarkerView view{.middle_px = {70.0, 70.0}, .depth_m = 2.0};
  PaintedFrame frame(size_of(camera));
  frame.marker(camera, view, 1782);
  frame.disc(dot_in_image(camera, view, {0, 2}) + Vec2(4.0, -9.0), 13.0);
  EXPECT_THAT(ids_in(frame.finished(random)), IsEmpty());
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

TEST(MarkerDetector, finds_nothing_where_nothing_is) {
  Random random(13);
  EXPECT_THAT(detect_markers(cv::Mat()), IsEmpty());
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 2), cv::Size(65, 1), cv::Size(640, 480)}) {
    for (const double gray : {0.0, 199.0, 200.0, 255.0}) {
      EXPECT_THAT(detect_markers(cv::Mat(size, CV_8UC1, cv::Scalar(gray))), IsEmpty());
    }
  }
  for (const double bright_share : {0.001, 0.01, 0.1, 0.5}) {
    cv::Mat speckled(300, 300, CV_8UC1);
    for (int i = 0; i < 300 * 300; ++i) {
      speckled.data[i] = random.uniform() < bright_share ? 255 : 30;
    }
    EXPECT_THAT(detect_markers(speckled), IsEmpty()) << "share " << bright_share;
  }
}

TEST(MarkerDetector, never_reads_a_marker_into_dots_strewn_at_random) {
  Random random(14);
  for (int i = 0; i < 100; ++i) {
    PaintedFrame frame(cv::Size(120, 120));
    for (int dot = 0; dot < 20; ++dot) {
      frame.disc({random.uniform(5.0, 115.0), random.uniform(5.0, 115.0)}, 2.5);
    }
    EXPECT_THAT(ids_in(frame.finished(random)), IsEmpty());
  }
}

TEST(MarkerDetector, refuses_frames_that_are_not_8_bit_gray) {
  EXPECT_THROW(detect_markers(cv::Mat(10, 10, CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(detect_markers(cv::Mat(10, 10, CV_16UC1)), std::invalid_argument);
}

}  // namespace
}  // namespace lodestar
