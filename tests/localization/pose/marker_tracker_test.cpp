#include "localization/pose/marker_tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/localization/painted_frame.hpp"

namespace lodestar {
namespace {

using testing::UnorderedElementsAre;

/// A camera at the map's origin looks straight up at markers in chosen views.
class SeenFromTheOrigin : public testing::Test {
 protected:
  void install(int id, const MarkerView& view) {
    const Vec3 place = camera_from_marker(camera_, view).translation();
    registry_.markers.push_back({.id = id, .position_m = place, .yaw_rad = view.turn_rad});
    frame_.marker(camera_, view, id);
  }

  void hang_three() {
    install(1782, {.middle_px = {150.0, 120.0}, .turn_rad = 0.4});
    install(447, {.middle_px = {480.0, 170.0}, .turn_rad = 2.0});
    install(3003, {.middle_px = {330.0, 390.0}, .turn_rad = -1.1});
  }

  /// Sigma of 1 cm and half a degree, with an actual error of about as much.
  ExpectedView expected_about(const Vec2& off_m = Vec2(0.01, -0.005)) const {
    ExpectedView view;
    view.map_from_camera.translation().head<2>() = off_m;
    view.covariance.diagonal() << 1e-4, 1e-4, 1e-6, 1e-6, 1e-6, 1e-4;
    return view;
  }

  static std::vector<int> ids(std::span<const DetectedMarker> markers) {
    std::vector<int> result;
    for (const DetectedMarker& marker : markers) result.push_back(marker.id);
    return result;
  }

  CameraModel camera_ = paper_camera();
  PaintedFrame frame_{cv::Size(camera_.width_px, camera_.height_px)};
  MarkerRegistry registry_;
  Random random_{7};
};

TEST_F(SeenFromTheOrigin, a_part_of_the_frame_tells_what_the_whole_tells) {
  hang_three();
  MarkerTracker tracker(registry_, camera_);
  MarkerDetector detector(expecting(registry_));
  int parts = 0;
  for (int i = 0; i < 20; ++i) {
    const cv::Mat gray = frame_.finished(random_);
    const std::span<const DetectedMarker> tracked = tracker.detect(gray, expected_about());
    const std::span<const DetectedMarker> all = detector.detect(gray);
    parts += tracker.searched_all() ? 0 : 1;
    ASSERT_EQ(ids(tracked), ids(all));
    for (std::size_t k = 0; k < all.size(); ++k) {
      ASSERT_EQ(tracked[k].dots.size(), all[k].dots.size());
      EXPECT_EQ(tracked[k].probability, all[k].probability);
      for (std::size_t d = 0; d < all[k].dots.size(); ++d)
        EXPECT_EQ(tracked[k].dots[d].center_px, all[k].dots[d].center_px);
    }
  }
  EXPECT_EQ(parts, 18) << "every tenth frame is searched in full";
}

TEST_F(SeenFromTheOrigin, without_an_expectation_all_is_searched) {
  hang_three();
  MarkerTracker tracker(registry_, camera_);
  EXPECT_THAT(ids(tracker.detect(frame_.finished(random_), std::nullopt)),
              UnorderedElementsAre(1782, 447, 3003));
  EXPECT_TRUE(tracker.searched_all());
}

TEST_F(SeenFromTheOrigin, a_wrong_expectation_is_noticed_at_once) {
  hang_three();
  MarkerTracker tracker(registry_, camera_);
  const cv::Mat gray = frame_.finished(random_);
  tracker.detect(gray, expected_about());
  EXPECT_THAT(ids(tracker.detect(gray, expected_about({0.4, 0.3}))), UnorderedElementsAre(1782, 447, 3003));
  EXPECT_TRUE(tracker.searched_all());
}

TEST_F(SeenFromTheOrigin, a_marker_that_hangs_elsewhere_is_found_within_ten_frames) {
  hang_three();
  registry_.markers[1].position_m.x() += 3.0;
  MarkerTracker tracker(registry_, camera_);
  int since_seen = 0;
  int most_since_seen = 0;
  for (int i = 0; i < 40; ++i) {
    const std::vector<int> found = ids(tracker.detect(frame_.finished(random_), expected_about()));
    EXPECT_THAT(found, testing::IsSupersetOf({1782, 3003}));
    since_seen = std::ranges::count(found, 447) > 0 ? 0 : since_seen + 1;
    most_since_seen = std::max(most_since_seen, since_seen);
  }
  EXPECT_EQ(most_since_seen, 9);
}

TEST_F(SeenFromTheOrigin, a_marker_that_is_gone_is_not_looked_for_everywhere_in_every_frame) {
  hang_three();
  const Vec3 place = camera_from_marker(camera_, {.middle_px = {330.0, 230.0}}).translation();
  registry_.markers.push_back({.id = 99, .position_m = place, .yaw_rad = 0.0});
  MarkerTracker tracker(registry_, camera_);
  int searched_all = 0;
  for (int i = 0; i < 40; ++i) {
    tracker.detect(frame_.finished(random_), expected_about());
    searched_all += tracker.searched_all() ? 1 : 0;
  }
  EXPECT_LE(searched_all, 5) << "once when the marker is lost, then every tenth frame";
}

TEST(ExpectedView, turns_the_camera_about_the_base) {
  PoseEstimate robot{.map_from_base = {{2.0, 1.0}, radians(30.0)}};
  robot.covariance.diagonal() << 0.0, 0.0, 1e-4;
  Eigen::Isometry3d base_from_camera = Eigen::Isometry3d::Identity();
  base_from_camera.translation() = Vec3(0.2, 0.1, 0.5);
  PosePrior prior;
  EXPECT_FALSE(expected_view(robot, base_from_camera, prior)) << "the tilt is unknown";
  prior.tilt_sigma_rad = 0.002;
  const std::optional<ExpectedView> view = expected_view(robot, base_from_camera, prior);
  ASSERT_TRUE(view);
  const Vec3 place = lifted(robot.map_from_base) * Vec3(0.2, 0.1, 0.5);
  EXPECT_LT((view->map_from_camera.translation() - place).norm(), 1e-12);

  PoseEstimate turned = robot;
  turned.map_from_base.yaw_rad += 1e-6;
  const Vec3 moved = 1e6 * (expected_view(turned, base_from_camera, prior)->map_from_camera.translation() -
                            view->map_from_camera.translation());
  EXPECT_LT(
      (view->covariance.topLeftCorner<2, 2>() - 1e-4 * moved.head<2>() * moved.head<2>().transpose()).norm(),
      1e-9);
  EXPECT_NEAR(view->covariance(3, 3), 4e-6, 1e-12);
  EXPECT_NEAR(view->covariance(5, 5), 1e-4, 1e-12);
}

}  // namespace
}  // namespace lodestar
