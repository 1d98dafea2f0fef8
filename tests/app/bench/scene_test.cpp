#include "app/bench/scene.hpp"

#include <gtest/gtest.h>
#include <set>

#include "app/bench/square_tags.hpp"
#include "app/bench/truth.hpp"
#include "localization/detection/marker_detector.hpp"
#include "localization/pose/pose_fix.hpp"

namespace lodestar {
namespace {

Vec2 middle_px(const BenchView& view, const MarkerRegistry& registry, std::size_t marker) {
  const Vec3 middle = map_from_marker(registry, registry.markers[marker]) * marker_middle;
  return *bench_camera().project(view.map_from_camera.inverse() * middle);
}

TEST(BenchScene, hangs_nine_dots_under_different_ids) {
  const MarkerRegistry registry = bench_registry({.markers = 3}, Random(1));
  std::set<int> ids;
  for (const RegisteredMarker& marker : registry.markers) {
    EXPECT_EQ(dots_of(marker.id).size(), 9U);
    ids.insert(marker.id);
  }
  EXPECT_EQ(ids.size(), registry.markers.size());
}

TEST(BenchScene, looks_where_it_says) {
  Random random(2);
  for (const double tilt_deg : {0.0, 20.0}) {
    for (const double off_axis_m : {0.0, 0.7}) {
      const BenchScene scene{.tilt_rad = radians(tilt_deg), .off_axis_m = off_axis_m};
      const MarkerRegistry registry = bench_registry(scene, Random(3));
      const BenchView view = some_view(scene, registry, random);
      const Vec3 up = view.map_from_camera.linear().col(2);
      EXPECT_NEAR(degrees(std::acos(up.z())), tilt_deg, 1e-6);
      if (tilt_deg > 0.0) continue;
      const Vec2 off =
          middle_px(view, registry, view.first_marker) - Vec2(bench_camera().cx_px, bench_camera().cy_px);
      EXPECT_NEAR(off.norm(), off_axis_m / 2.6 * bench_camera().fx_px, 6.0);
    }
  }
}

TEST(BenchScene, is_read_by_us_where_the_truth_has_its_markers) {
  const BenchScene scene{.markers = 3};
  const MarkerRegistry registry = bench_registry(scene, Random(4));
  ImageFormer former(registry, bench_camera(), light_of(scene), 1);
  Random random(5);
  const BenchView view = some_view(scene, registry, random);
  const cv::Mat gray = former.expose(view.map_from_camera, view.map_from_camera, 0);
  const auto method = lodestar_method().make();
  const auto truth = markers_in_view(*method, registry, view.map_from_camera, bench_camera());
  EXPECT_EQ(truth.size(), 3U);
  const ReadingCount count = judged(method->read(gray), truth);
  EXPECT_EQ(count.right, 3);
  EXPECT_EQ(count.wrong, 0);
}

TEST(BenchTruth, calls_a_right_id_at_another_place_wrong) {
  const std::vector<TrueMarker> truth{{7, {100.0, 100.0}}};
  EXPECT_TRUE(is_right({7, {102.0, 100.0}, {}}, truth));
  EXPECT_FALSE(is_right({7, {200.0, 100.0}, {}}, truth));
  EXPECT_FALSE(is_right({8, {100.0, 100.0}, {}}, truth));
}

/// Checks the conventions assumed for a peer's corners, pixel centres and frames: on a good frame, at any yaw
/// of tag and camera, both poses must be true within noise.
class Peer : public testing::TestWithParam<const char*> {};

TEST_P(Peer, finds_the_camera_where_it_is) {
  const std::vector<MethodChoice> choices = peer_methods(GetParam());
  if (choices.empty()) GTEST_SKIP() << "built without " << GetParam();
  const BenchScene scene{.noise_gray = 1.0, .height_m = 1.5, .tilt_rad = radians(12.0), .texture_gray = 0.0};
  const MarkerRegistry registry = bench_registry(scene, Random(6));
  for (const MethodChoice& choice : choices) {
    const auto method = choice.make();
    ImageFormer former(registry, bench_camera(), light_of(scene), 1);
    method->install(registry, bench_camera(), former);
    Random random(7);
    for (std::uint64_t frame = 0; frame < 4; ++frame) {
      const BenchView view = some_view(scene, registry, random);
      const cv::Mat gray = former.expose(view.map_from_camera, view.map_from_camera, frame);
      const MethodResult result = method->run(gray, registry, bench_camera(), view.tilt);
      const auto truth = markers_in_view(*method, registry, view.map_from_camera, bench_camera());
      EXPECT_EQ(judged(result.markers, truth).right, 1) << choice.settings;
      ASSERT_TRUE(result.upright && result.free) << choice.settings;
      const Vec3 off = result.upright->translation() - view.map_from_camera.translation();
      EXPECT_LT(off.head<2>().norm(), 0.02) << choice.settings;
      EXPECT_LT(std::abs(off.z()), 0.05) << choice.settings;
      EXPECT_LT((result.free->translation() - view.map_from_camera.translation()).norm(), 0.3)
          << choice.settings;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BenchMethods, Peer, testing::Values("apriltag", "aruco"));

}  // namespace
}  // namespace lodestar
