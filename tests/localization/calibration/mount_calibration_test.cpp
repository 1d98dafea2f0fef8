#include "localization/calibration/mount_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/marker.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Ground truth of a robot that turns and drives below a ceiling of markers.
struct Truth {
  RollPitchYaw angles{radians(0.9), radians(-1.3), radians(3.0)};
  Vec3 position_m{-0.13, 0.04, 1.08};
  double left_scale = 1.006;
  double right_scale = 0.994;
  double track_width_m = 0.404;
  double wobble_rad = 0.001;
  double marker_spacing_m = 0.7;
  double ceiling_m = 2.6;
};

constexpr double track_as_believed_m = 0.40;
constexpr double dot_sigma_px = 0.03;

class Robot {
 public:
  Robot(const Truth& truth, std::uint64_t seed) : truth_(truth), random_(seed) {
    for (int i = -6; i <= 6; ++i) {
      for (int j = -6; j <= 6; ++j) {
        registry_.markers.push_back(
            {static_cast<int>(random_.below(marker_id_count)),
             {i * truth.marker_spacing_m, j * truth.marker_spacing_m, truth.ceiling_m},
             random_.uniform(-3.0, 3.0),
             0});
      }
    }
    base_from_camera_.linear() = rotation_from(truth.angles);
    base_from_camera_.translation() = truth.position_m;
  }

  /// Rolls the wheels by the reported distances; each step leaves a frame.
  void roll(double left_m, double right_m, int steps) {
    for (int i = 0; i < steps; ++i) {
      const double slip_m = 0.002 * std::sqrt(std::abs(left_m) / steps);
      const double left = truth_.left_scale * left_m / steps + slip_m * random_.normal();
      const double right = truth_.right_scale * right_m / steps + slip_m * random_.normal();
      const double turn = (right - left) / truth_.track_width_m;
      base_ = base_ * Pose2{Vec2::Zero(), 0.5 * turn} * Pose2{{0.5 * (left + right), 0.0}, 0.5 * turn};
      rolled_left_m_ += left_m / steps;
      rolled_right_m_ += right_m / steps;
      take_frame();
    }
  }
  void turn(double turns) {
    const double rim_m = 0.5 * track_as_believed_m * 2.0 * std::numbers::pi * turns;
    roll(-rim_m, rim_m, static_cast<int>(50.0 * std::abs(turns)));
  }
  void drive(double distance_m) {
    roll(distance_m, distance_m, static_cast<int>(20.0 * std::abs(distance_m)));
  }

  [[nodiscard]] const std::vector<MountFrame>& frames() const { return frames_; }
  [[nodiscard]] std::vector<MountFrame>& frames() { return frames_; }

 private:
  void take_frame() {
    Eigen::Isometry3d wobble = Eigen::Isometry3d::Identity();
    wobble.linear() =
        rotation_from({truth_.wobble_rad * random_.normal(), truth_.wobble_rad * random_.normal(), 0.0});
    const Eigen::Isometry3d map_from_camera = lifted(base_) * wobble * base_from_camera_;
    MountFrame frame{.left_m = std::round(2000.0 * rolled_left_m_) / 2000.0,
                     .right_m = std::round(2000.0 * rolled_right_m_) / 2000.0};
    frame.map_from_camera = map_from_camera;
    frame.map_from_camera.translation() += 0.005 * Vec3(random_.normal(), random_.normal(), random_.normal());
    for (const RegisteredMarker& marker : registry_.markers) add_marker(map_from_camera, marker, frame);
    if (!frame.dots.empty()) frames_.push_back(frame);
  }

  void add_marker(const Eigen::Isometry3d& map_from_camera, const RegisteredMarker& marker,
                  MountFrame& frame) {
    std::vector<SurveyedDot> dots;
    for (const GridCell cell : dots_of(marker.id)) {
      const Vec2 at = cell_in_marker(cell);
      const Vec3 point = map_from_marker(registry_, marker) * Vec3(at.x(), at.y(), 0.0);
      const auto pixel = camera.project(map_from_camera.inverse() * point);
      if (!pixel || !camera.contains(*pixel, 5.0)) return;
      dots.push_back({point, *pixel + dot_sigma_px * Vec2(random_.normal(), random_.normal())});
    }
    frame.dots.insert(frame.dots.end(), dots.begin(), dots.end());
  }

 public:
  CameraModel camera{640, 480, 320.0, 320.0, 319.5, 239.5, Distortion::plumb_bob, {-0.06, 0.01}};

 private:
  Truth truth_;
  Random random_;
  MarkerRegistry registry_;
  Eigen::Isometry3d base_from_camera_ = Eigen::Isometry3d::Identity();
  Pose2 base_;
  double rolled_left_m_ = 0.0;
  double rolled_right_m_ = 0.0;
  std::vector<MountFrame> frames_;
};

MountBelief as_drawn() {
  return {.angles = {},
          .position_m = {-0.10, 0.0, 1.1},
          .track_width_m = track_as_believed_m,
          .wobble_sigma_rad = 0.001};
}

MountCalibration calibrated(const Robot& robot) {
  return calibrate_mount(robot.frames(), robot.camera, as_drawn());
}

TEST(CalibrateMount, measures_the_whole_mount_from_turns_and_a_straight_drive) {
  const Truth truth;
  Robot robot(truth, 1);
  robot.turn(5.0);
  robot.drive(1.5);
  robot.drive(-1.5);
  const MountCalibration result = calibrated(robot);
  ASSERT_THAT(result.flaws, IsEmpty());
  EXPECT_NEAR(result.turns, 5.0, 0.2);
  EXPECT_NEAR(result.circle->radius_m, truth.position_m.head<2>().norm(), 0.05);
  const MountEstimate& mount = *result.estimate;
  EXPECT_TRUE(mount.measured_height && mount.measured_tilt && mount.measured_yaw);
  EXPECT_LT((mount.position_m - truth.position_m).norm(), 0.003);
  EXPECT_NEAR(degrees(mount.angles.roll_rad), 0.9, 0.05);
  EXPECT_NEAR(degrees(mount.angles.pitch_rad), -1.3, 0.05);
  EXPECT_NEAR(degrees(mount.angles.yaw_rad), 3.0, 0.3);
  EXPECT_NEAR(mount.dot_rms_px, dot_sigma_px * std::numbers::sqrt2, 0.005);
}

TEST(CalibrateMount, says_how_uncertain_each_part_is) {
  const Truth truth;
  constexpr int drives = 12;
  std::array<double, 6> mean_square{};
  for (int drive = 0; drive < drives; ++drive) {
    Robot robot(truth, static_cast<std::uint64_t>(20 + drive));
    robot.turn(3.0);
    robot.drive(1.5);
    const MountCalibration result = calibrated(robot);
    ASSERT_TRUE(result.estimate.has_value());
    const MountEstimate& mount = *result.estimate;
    const Vec3 off = (mount.position_m - truth.position_m).cwiseQuotient(mount.position_sigmas_m);
    const std::array<double, 6> errors{
        off.x(),
        off.y(),
        off.z(),
        (mount.angles.roll_rad - truth.angles.roll_rad) / mount.angle_sigmas.roll_rad,
        (mount.angles.pitch_rad - truth.angles.pitch_rad) / mount.angle_sigmas.pitch_rad,
        (mount.angles.yaw_rad - truth.angles.yaw_rad) / mount.angle_sigmas.yaw_rad};
    for (std::size_t i = 0; i < errors.size(); ++i) mean_square[i] += errors[i] * errors[i] / drives;
  }
  // Chi-square with 12 degrees of freedom, 99.9 %. The lower bound is loose: the assumed slip is larger than
  // the simulated one.
  EXPECT_THAT(mean_square, ::testing::Each(::testing::Lt(2.75)));
  EXPECT_THAT(mean_square, ::testing::Each(::testing::Gt(0.003)));
}

TEST(CalibrateMount, finds_a_camera_that_is_mounted_crosswise) {
  Truth truth;
  truth.angles.yaw_rad = radians(-92.0);
  Robot robot(truth, 3);
  robot.turn(-3.0);
  robot.drive(1.5);
  const MountCalibration result = calibrated(robot);
  ASSERT_THAT(result.flaws, IsEmpty());
  EXPECT_NEAR(degrees(result.estimate->angles.yaw_rad), -92.0, 0.4);
  EXPECT_LT((result.estimate->position_m - truth.position_m).norm(), 0.004);
}

TEST(CalibrateMount, keeps_the_yaw_when_the_robot_only_turned) {
  Truth truth;
  truth.angles.yaw_rad = 0.0;
  Robot robot(truth, 4);
  robot.turn(5.0);
  const MountCalibration result = calibrated(robot);
  ASSERT_THAT(result.flaws, IsEmpty());
  EXPECT_FALSE(result.estimate->measured_yaw);
  EXPECT_EQ(result.estimate->angle_sigmas.yaw_rad, 0.0);
  EXPECT_NEAR(result.estimate->angles.yaw_rad, 0.0, 1e-9);
  EXPECT_LT((result.estimate->position_m - truth.position_m).norm(), 0.004);
}

TEST(CalibrateMount, keeps_the_tilt_when_one_far_marker_does_not_show_it) {
  // One marker straight above: tilt and position cannot be told apart.
  Truth truth;
  truth.marker_spacing_m = 20.0;
  truth.ceiling_m = 4.0;
  truth.angles = {};
  Robot robot(truth, 5);
  robot.turn(2.2);
  const MountCalibration result = calibrated(robot);
  ASSERT_TRUE(result.estimate.has_value());
  EXPECT_FALSE(result.estimate->measured_tilt);
  EXPECT_EQ(result.estimate->angles.pitch_rad, 0.0);
  EXPECT_LT((result.estimate->position_m - truth.position_m).head<2>().norm(), 0.004);
}

TEST(CalibrateMount, refuses_a_log_with_few_frames_or_turns) {
  Robot short_one(Truth{}, 6);
  short_one.turn(0.5);
  EXPECT_THAT(calibrated(short_one).flaws, ElementsAre(MountFlaw::too_few_fixes, MountFlaw::too_few_turns));
  Robot straight_one(Truth{}, 7);
  straight_one.drive(4.0);
  EXPECT_THAT(calibrated(straight_one).flaws, ElementsAre(MountFlaw::too_few_turns));
  EXPECT_THAT(calibrate_mount({}, straight_one.camera, as_drawn()).flaws, Contains(MountFlaw::too_few_fixes));
}

TEST(CalibrateMount, refuses_wheels_that_tell_of_another_drive) {
  Robot robot(Truth{}, 8);
  robot.turn(5.0);
  for (MountFrame& frame : robot.frames()) std::swap(frame.left_m, frame.right_m);
  EXPECT_THAT(calibrated(robot).flaws, Contains(MountFlaw::contradiction));
}

TEST(CalibrateMount, refuses_dots_that_fit_no_ceiling) {
  Robot robot(Truth{}, 9);
  robot.turn(3.0);
  Random random(1);
  for (MountFrame& frame : robot.frames()) {
    for (SurveyedDot& dot : frame.dots) dot.center_px += 3.0 * Vec2(random.normal(), random.normal());
  }
  EXPECT_THAT(calibrated(robot).flaws, Contains(MountFlaw::contradiction));
}

}  // namespace
}  // namespace lodestar
