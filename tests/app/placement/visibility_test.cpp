#include "app/placement/visibility.hpp"

#include <filesystem>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "tests/maps/empty_floor.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

/// 4 m x 2 m of free floor in cells of 10 cm.
OccupancyMap hall() {
  return empty_floor(40, 20, 0.1);
}

/// Field of view of 90 degrees: 3 m x 2.25 m of the ceiling from 1.5 m below.
CameraModel wide_camera() {
  return {.width_px = 640, .height_px = 480, .fx_px = 320.0, .fy_px = 320.0, .cx_px = 319.5, .cy_px = 239.5};
}

RegisteredMarker marker_at(int id, double x_m, double y_m) {
  return {.id = id, .position_m = {x_m, y_m, 2.6}};
}

VisibilityOptions upright() {
  VisibilityOptions options;
  options.base_from_camera.translation().z() = 1.1;
  options.fix.prior.tilt_sigma_rad = 0.0;
  options.fix.prior.height_m = 1.1;
  return options;
}

const CellView& view_at(const Visibility& visibility, double x_m, double y_m) {
  return *visibility.cells[visibility.map.index(visibility.map.cell_at({x_m, y_m}))];
}

TEST(Visibility, counts_what_the_camera_can_see) {
  const MarkerRegistry registry{.map_from_registry = {},
                                .markers = {marker_at(447, 0.5, 1.0), marker_at(1782, 1.3, 1.0)}};
  const Visibility visibility = visibility_of(hall(), registry, wide_camera(), nullptr, upright());
  EXPECT_EQ(view_at(visibility, 0.95, 1.05).least, 2);
  EXPECT_EQ(view_at(visibility, 1.75, 1.05).least, 1) << "the other is in view at some headings";
  EXPECT_EQ(view_at(visibility, 1.75, 1.05).most, 2);
  EXPECT_EQ(view_at(visibility, 3.95, 1.05).most, 0);
  EXPECT_FALSE(view_at(visibility, 3.95, 1.05).position_sigma_m);
}

TEST(Visibility, expects_what_the_pose_estimate_will_claim) {
  const MarkerRegistry registry{.map_from_registry = {}, .markers = {marker_at(447, 1.0, 1.0)}};
  const VisibilityOptions exact = upright();
  VisibilityOptions tilted = upright();
  tilted.fix.prior.tilt_sigma_rad = radians(0.1);
  const Visibility sure = visibility_of(hall(), registry, wide_camera(), nullptr, exact);
  const Visibility unsure = visibility_of(hall(), registry, wide_camera(), nullptr, tilted);
  const double exact_m = *view_at(sure, 1.05, 1.05).position_sigma_m;
  const double tilted_m = *view_at(unsure, 1.05, 1.05).position_sigma_m;
  EXPECT_LT(exact_m, 0.001) << "some ten dots of 0.03 px at 1.5 m";
  EXPECT_NEAR(std::sqrt(tilted_m * tilted_m - exact_m * exact_m), 2.6 * radians(0.1), 3e-4)
      << "the robot's tilt, times the height of the ceiling above its floor";
  EXPECT_GT(*view_at(sure, 1.05, 1.85).position_sigma_m, exact_m) << "sigma grows with distance";
}

TEST(Visibility, sums_up_shares_and_the_largest_gap) {
  const MarkerRegistry registry{.map_from_registry = {}, .markers = {marker_at(447, 0.5, 1.0)}};
  OccupancyMap map = hall();
  const VisibilitySummary all = summarize(visibility_of(map, registry, wide_camera(), nullptr, upright()));
  EXPECT_EQ(all.cells, 800U);
  EXPECT_GT(all.share_one, 0.2);
  EXPECT_LT(all.share_one, all.share_some_heading);
  EXPECT_EQ(all.share_two, 0.0);
  EXPECT_EQ(all.cells_cut_off, 0U);
  EXPECT_NEAR(all.gap_at_m.x(), 3.95, 1e-9);
  EXPECT_NEAR(all.largest_gap_m, 2.5, 0.4);

  for (int row = 0; row < 20; ++row) map.cells[map.index({30, row})] = OccupancyMap::occupied;
  const VisibilitySummary walled = summarize(visibility_of(map, registry, wide_camera(), nullptr, upright()));
  EXPECT_EQ(walled.cells, 780U);
  EXPECT_EQ(walled.cells_cut_off, 9U * 20U) << "the room behind the wall";
  VisibilityOptions wide = upright();
  wide.robot_radius_m = 0.35;
  EXPECT_LT(summarize(visibility_of(map, registry, wide_camera(), nullptr, wide)).cells, 500U);
}

TEST(Visibility, sees_no_marker_where_the_distortion_folds_back) {
  CameraModel camera = wide_camera();
  camera.distortion = Distortion::plumb_bob;
  camera.coefficients = {-0.33, 0.13, 0.0, 0.0, -0.02};
  camera.limit_rays();
  const MarkerRegistry registry{.map_from_registry = {}, .markers = {marker_at(447, 0.3, 1.0)}};
  const Visibility visibility = visibility_of(hall(), registry, camera, nullptr, upright());
  EXPECT_EQ(view_at(visibility, 1.05, 1.05).least, 1);
  for (double x_m = 2.95; x_m < 4.0; x_m += 0.1)
    EXPECT_EQ(view_at(visibility, x_m, 1.05).most, 0) << "1.5 m below, " << x_m - 0.3 << " m aside";
}

TEST(Visibility, does_not_see_through_walls) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "wall.bt";
  octomap::OcTree tree(0.1);
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 20; ++y) {
      for (int z = 0; z < 27; ++z) {
        const bool wall = x == 20;
        const bool ceiling = z == 26;
        tree.updateNode(0.05 + 0.1 * x, 0.05 + 0.1 * y, 0.05 + 0.1 * z, wall || ceiling);
      }
    }
  }
  ASSERT_TRUE(tree.writeBinary(file.string()));
  const SightLines sight_lines(file);
  const MarkerRegistry registry{.map_from_registry = {}, .markers = {marker_at(447, 1.5, 1.0)}};
  const Visibility with_wall = visibility_of(hall(), registry, wide_camera(), &sight_lines, upright());
  const Visibility without = visibility_of(hall(), registry, wide_camera(), nullptr, upright());
  EXPECT_EQ(view_at(with_wall, 1.55, 1.05).least, 1) << "right below; the ceiling hides nothing";
  EXPECT_EQ(view_at(without, 2.25, 1.05).least, 1);
  EXPECT_EQ(view_at(with_wall, 2.25, 1.05).most, 0);
}

}  // namespace
}  // namespace lodestar
