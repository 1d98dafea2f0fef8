#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "localization/detection/marker_detector.hpp"
#include "localization/pose/paper_pose.hpp"
#include "maps/paper_camera.hpp"

#include "tests/localization/painted_frame.hpp"
#include "tests/localization/seen_markers.hpp"

// The paper's method as published: what it achieves, and that it uses none of our improvements.
namespace lodestar {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A view of the first marker of ceiling() from 0.3 to 0.6 m aside, tilted a little.
Eigen::Isometry3d view_aside(Random& random) {
  const double towards = random.uniform(-3.1, 3.1);
  const Vec3 aside = random.uniform(0.3, 0.6) * Vec3(std::cos(towards), std::sin(towards), 0.0);
  return view_from(Vec3(1.0, 2.0, random.uniform(0.0, 0.8)) + aside, random.uniform(-3.1, 3.1),
                   radians(random.uniform(-2.0, 2.0)), radians(random.uniform(-2.0, 2.0)));
}

CameraModel distorted_camera() {
  CameraModel camera = paper_camera();
  camera.distortion = Distortion::plumb_bob;
  camera.coefficients = {-0.06, 0.01, 0.0004, -0.0003};
  return camera;
}

double off(const PaperFix& fix, const Eigen::Isometry3d& truth) {
  return (fix.map_from_camera.matrix() - truth.matrix()).cwiseAbs().maxCoeff();
}

TEST(PaperPose, without_noise_is_the_truth) {
  Random random(1);
  for (const CameraModel& camera : {paper_camera(), distorted_camera()}) {
    for (int i = 0; i < 300; ++i) {
      const Eigen::Isometry3d view = view_aside(random);
      const auto markers = seen(view, ceiling(), camera, 0.0, random);
      const auto fix = fix_pose_as_in_paper(Stamp{}, markers, ceiling(), camera);
      ASSERT_TRUE(fix.has_value());
      EXPECT_EQ(fix->id, 447);
      EXPECT_LT(off(*fix, view), 1e-6);
    }
  }
}

TEST(PaperPose, rests_on_the_first_markers_direction_dots_alone) {
  Random random(2);
  const Eigen::Isometry3d view = view_aside(random);
  auto markers = seen(view, ceiling(), paper_camera(), 0.0, random);
  for (DetectedMarker& marker : markers) {
    for (MarkerDot& dot : marker.dots) dot.center_px += Vec2(3.0, -4.0);
  }
  markers[1].o_px += Vec2(20.0, 0.0);
  const auto fix = fix_pose_as_in_paper(Stamp{}, markers, ceiling(), paper_camera());
  ASSERT_TRUE(fix.has_value());
  EXPECT_LT(off(*fix, view), 1e-6);
}

TEST(PaperPose, is_none_when_the_optimal_marker_is_not_registered_once) {
  Random random(3);
  const auto markers = seen(view_aside(random), ceiling(), paper_camera(), 0.0, random);
  MarkerRegistry without_the_first = ceiling();
  without_the_first.markers.erase(without_the_first.markers.begin());
  MarkerRegistry with_it_twice = ceiling();
  with_it_twice.markers.push_back(with_it_twice.markers.front());
  EXPECT_FALSE(fix_pose_as_in_paper(Stamp{}, markers, without_the_first, paper_camera()));
  EXPECT_FALSE(fix_pose_as_in_paper(Stamp{}, markers, with_it_twice, paper_camera()));
  EXPECT_FALSE(fix_pose_as_in_paper(Stamp{}, {}, ceiling(), paper_camera()));
}

/// Root mean square distance in the plane.
class Spread {
 public:
  void add(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
    sum_m2_ += (estimate.translation() - truth.translation()).head<2>().squaredNorm();
    ++count_;
  }
  [[nodiscard]] double rms_m() const { return std::sqrt(sum_m2_ / count_); }

 private:
  double sum_m2_ = 0.0;
  int count_ = 0;
};

// The Cramér-Rao bound is 83 mm for it, and 0.46 mm for nine dots with known tilt, at noise of 0.05 px and
// 2.6 m.
TEST(PaperPose, loses_by_far_to_all_dots_with_the_tilt_known) {
  Random random(4);
  const MarkerRegistry registry{.markers = {{447, Vec3(0.0, 0.0, 2.6), 0.3, 0}}};
  PoseFixOptions upright;
  upright.prior.tilt_sigma_rad = 0.0;
  Spread by_the_paper;
  Spread by_us;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Isometry3d view =
        view_from({random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.0}, random.uniform(-3.1, 3.1));
    const auto markers = seen(view, registry, paper_camera(), 0.05, random);
    const auto paper = fix_pose_as_in_paper(Stamp{}, markers, registry, paper_camera());
    const auto ours = fix_pose(Stamp{}, markers, registry, paper_camera(), upright);
    if (!paper) continue;
    ASSERT_TRUE(ours.has_value());
    by_the_paper.add(paper->map_from_camera, view);
    by_us.add(ours->map_from_camera, view);
  }
  EXPECT_GT(by_the_paper.rms_m(), 0.03);
  EXPECT_LT(by_the_paper.rms_m(), 0.15);
  EXPECT_GT(by_the_paper.rms_m(), 20.0 * by_us.rms_m());
}

TEST(PaperMount, is_eq_17_for_a_camera_straight_ahead) {
  const double theta = radians(50.0);
  const Pose2 base =
      compensate_mount_as_in_paper(lifted({{3.0, 4.0}, theta}, 1.1), lifted({{0.2, 0.0}, 0.0}, 1.1));
  EXPECT_NEAR(base.position_m.x(), 3.0 - 0.2 * std::cos(theta), 1e-12);
  EXPECT_NEAR(base.position_m.y(), 4.0 - 0.2 * std::sin(theta), 1e-12);
  EXPECT_NEAR(base.yaw_rad, theta, 1e-12);
}

TEST(PaperMount, finds_the_base_for_any_place_and_yaw_of_the_camera) {
  const Pose2 base{{-1.0, 2.0}, radians(-130.0)};
  const Eigen::Isometry3d base_from_camera = lifted({{-0.15, 0.08}, radians(90.0)}, 1.1);
  const Pose2 found = compensate_mount_as_in_paper(lifted(base) * base_from_camera, base_from_camera);
  EXPECT_LT((found.position_m - base.position_m).norm(), 1e-12);
  EXPECT_NEAR(found.yaw_rad, base.yaw_rad, 1e-12);
}

std::vector<int> ids_read(const cv::Mat& gray, const DetectorOptions& options) {
  std::vector<int> ids;
  for (const DetectedMarker& marker : detect_markers(gray, options)) ids.push_back(marker.id);
  return ids;
}

const MarkerView in_the_middle{.middle_px = {320.0, 240.0}, .depth_m = 2.0, .turn_rad = 0.3};

TEST(PaperDetection, sums_up_the_dots_that_it_finds) {
  Random random(5);
  PaintedFrame frame({640, 480});
  frame.marker(paper_camera(), in_the_middle, 1782);
  frame.dot(paper_camera(), in_the_middle, {1, 1}, 150.0);
  const cv::Mat gray = frame.finished(random);
  EXPECT_THAT(ids_read(gray, paper_detection()), ElementsAre(1782 - id_bit({1, 1}))) << "darker than 200";
  EXPECT_THAT(ids_read(gray, {.registered_ids = {1782}}), ElementsAre(1782));
}

TEST(PaperDetection, has_no_lattice_where_something_bright_is_beside_a_marker) {
  Random random(6);
  PaintedFrame frame({640, 480});
  frame.marker(paper_camera(), in_the_middle, 1782);
  const double radius_px = marker_dot_radius_m * paper_camera().fx_px / in_the_middle.depth_m;
  frame.disc(in_the_middle.middle_px + Vec2(50.0, 10.0), radius_px);
  const cv::Mat gray = frame.finished(random);
  EXPECT_THAT(ids_read(gray, {.registered_ids = {1782}}), ElementsAre(1782));
  EXPECT_THAT(ids_read(gray, paper_detection()), IsEmpty());
}

TEST(PaperDetection, tries_nothing_but_the_farthest_pair) {
  Random random(8);
  PaintedFrame frame({640, 480});
  const double pitch_px = marker_pitch_m * paper_camera().fx_px / 2.0;
  for (const double side : {-1.0, 1.0}) {
    const Vec2 middle(320.0 + 2.75 * side * pitch_px, 240.0);  // 2.5 pitches between them: one dilated area
    frame.marker(paper_camera(), {.middle_px = middle, .depth_m = 2.0}, 4095);
  }
  const cv::Mat gray = frame.finished(random);
  EXPECT_THAT(ids_read(gray, {}), ElementsAre(4095, 4095));
  EXPECT_THAT(ids_read(gray, paper_detection()), IsEmpty());
}

TEST(PaperDetection, puts_the_marker_nearest_to_the_centre_first) {
  Random random(7);
  PaintedFrame frame({640, 480});
  frame.marker(paper_camera(), {.middle_px = {150.0, 120.0}, .depth_m = 2.0}, 447);
  frame.marker(paper_camera(), {.middle_px = {380.0, 270.0}, .depth_m = 2.0}, 1782);
  EXPECT_THAT(ids_read(frame.finished(random), paper_detection()), ElementsAre(1782, 447));
}

}  // namespace
}  // namespace lodestar
