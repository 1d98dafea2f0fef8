#include <algorithm>
#include <array>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdexcept>

#include "tests/localization/detection/detector_frames.hpp"

// Patterns that are no marker, and markers that cannot be read reliably.
namespace lodestar {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// The marker slides out of the frame. While any of its coded cells, even an empty one, may be cut, it is
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

// An object as gray as the ceiling hides dots: the rest is the pattern of an ID that is not registered.
TEST(MarkerDetector, refuses_ids_that_are_not_registered) {
  Random random(16);
  const CameraModel camera = cropped(paper_camera(), 120);
  PaintedFrame frame(size_of(camera));
  frame.marker(camera, {.middle_px = {60.0, 60.0}, .depth_m = 2.6, .turn_rad = 0.3}, 1542);
  const cv::Mat gray = frame.finished(random);
  EXPECT_THAT(ids_in(gray), ElementsAre(1542));
  EXPECT_THAT(detect_markers(gray, {.registered_ids = {447, 1782}}), IsEmpty());
}

/// A marker with a dot hidden, but for a sliver, by an object as gray as the ceiling.
cv::Mat with_a_sliver(const CameraModel& camera, int id, GridCell hidden, Random& random) {
  const MarkerView view{.middle_px = {60.0, 60.0}, .depth_m = 2.6, .turn_rad = 0.3};
  const double radius_px = marker_dot_radius_m * camera.fx_px / view.depth_m;
  PaintedFrame frame(size_of(camera));
  frame.marker(camera, view, id);
  frame.disc(dot_in_image(camera, view, hidden) + Vec2(0.7 * radius_px, 0.0), 1.3 * radius_px, 35.0);
  return frame.finished(random);
}

// The sliver of a dot shows that an object occludes the marker, which may hide another dot completely.
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

/// The pin of a sprinkler on a bright ceiling, over a marker or beside it, returns about half of what a dot
/// does.
TEST(MarkerDetector, reads_a_marker_by_the_bright_pin_of_a_sprinkler_as_itself) {
  Random random(19);
  const CameraModel camera = cropped(paper_camera(), 160);
  constexpr int markers = 300;
  int read = 0;
  for (int i = 0; i < markers; ++i) {
    const MarkerView view{
        .middle_px = {80.0, 80.0}, .depth_m = 2.6, .turn_rad = radians(random.uniform(0.0, 360.0))};
    const double radius_px = marker_dot_radius_m * camera.fx_px / view.depth_m;
    const int id = random_id(random);
    const int bit = 1 << random.below(12);
    PaintedFrame frame(size_of(camera), 135.0);
    const Vec2 off_pitches(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0));
    frame.disc(view.middle_px + 4.0 * radius_px * off_pitches, random.uniform(0.8, 1.3) * radius_px,
               random.uniform(180.0, 200.0));
    frame.marker(camera, view, id);
    const cv::Mat gray = frame.finished(random);
    for (const DetectedMarker& marker : detect_markers(gray, {.registered_ids = {id, id ^ bit}}))
      EXPECT_EQ(marker.id, id) << i;
    read += detect_markers(gray, {.registered_ids = {id}}).empty() ? 0 : 1;
  }
  RecordProperty("read", read);
  EXPECT_GT(read, 0.95 * markers);
}

// Some dots of a marker tilted too steeply to be read may match another marker, seen less tilted and turned;
// the remaining dots show that this is wrong.
TEST(MarkerDetector, never_reads_a_marker_into_a_part_of_a_steeply_tilted_one) {
  Random random(18);
  const CameraModel camera = cropped(paper_camera(), 120);
  int read = 0;
  for (int i = 0; i < 300; ++i) {
    const int id = random_id(random);
    const MarkerView view{.middle_px = {60.0, 60.0},
                          .depth_m = 2.0,
                          .turn_rad = radians(random.uniform(0.0, 360.0)),
                          .tilt_rad = radians(random.uniform(30.0, 55.0)),
                          .tilt_axis_rad = radians(random.uniform(0.0, 360.0))};
    PaintedFrame frame(size_of(camera));
    frame.marker(camera, view, id);
    const std::vector<int> found = ids_in(frame.finished(random));
    EXPECT_THAT(found, testing::AnyOf(IsEmpty(), ElementsAre(id))) << "frame " << i;
    read += found.empty() ? 0 : 1;
  }
  EXPECT_GT(read, 10) << "the least tilted markers are read";
  EXPECT_LT(read, 290) << "the others are refused";
}

// A dirty dot taken for an empty cell would change the ID: it must count as a dot, or the marker is refused.
TEST(MarkerDetector, never_takes_a_dirty_dot_for_an_empty_cell) {
  Random random(9);
  const CameraModel camera = cropped(paper_camera(), 120);
  int read = 0;
  int refused = 0;
  for (double gray = 70.0; gray <= 240.0; gray += 10.0) {
    const MarkerView view{.middle_px = {60.0, 60.0}, .depth_m = 2.6, .turn_rad = 0.3};
    PaintedFrame frame(size_of(camera));
    frame.marker(camera, view, 1782);
    frame.dot(camera, view, {1, 1}, gray);
    const std::vector<int> found = ids_in(frame.finished(random));
    EXPECT_THAT(found, testing::AnyOf(IsEmpty(), ElementsAre(1782))) << gray;
    ++(found.empty() ? refused : read);
  }
  EXPECT_GT(read, 5) << "it counts as a dot";
  EXPECT_GT(refused, 0) << "or the marker is refused";
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

/// The light between the holes of a perforated plate: a patch of a lattice with a marker's pitch, larger than
/// a marker, of which some dots are too faint.
TEST(MarkerDetector, never_reads_a_marker_into_a_larger_lattice) {
  Random random(15);
  DetectorOptions expecting_many;
  for (int id = 0; id < marker_id_count; id += 16) expecting_many.registered_ids.push_back(id + 15);
  MarkerDetector detector(expecting_many);
  constexpr double radius_px = 2.5;
  constexpr double pitch_px = radii_per_pitch * radius_px;
  for (int i = 0; i < 500; ++i) {
    PaintedFrame frame(cv::Size(120, 120));
    const Eigen::Rotation2Dd turn(random.uniform(0.0, 1.5));
    const int columns = 5 + static_cast<int>(random.below(2));
    const int rows = 4 + static_cast<int>(random.below(3));
    for (int column = 0; column < columns; ++column) {
      for (int row = 0; row < rows; ++row) {
        const Vec2 place(column - 0.5 * (columns - 1), row - 0.5 * (rows - 1));
        if (random.uniform() < 0.8) frame.disc(Vec2(60.0, 60.0) + pitch_px * (turn * place), radius_px);
      }
    }
    EXPECT_TRUE(detector.detect(frame.finished(random)).empty()) << i;
  }
}

TEST(MarkerDetector, refuses_frames_that_are_not_8_bit_gray) {
  EXPECT_THROW(detect_markers(cv::Mat(10, 10, CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(detect_markers(cv::Mat(10, 10, CV_16UC1)), std::invalid_argument);
}

}  // namespace
}  // namespace lodestar
