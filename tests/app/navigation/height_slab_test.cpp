#include "localization/scan/height_slab.hpp"

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "drivers/simulation/simulated_depth_camera.hpp"

// What a simulated depth camera shows of a table, whose top is above the plane of any scanner.
namespace lodestar {
namespace {

OccupancyMap hall() {
  OccupancyMap map{.columns = 200, .rows = 120, .resolution_m = 0.05};
  map.cells.assign(200UL * 120UL, OccupancyMap::free);
  for (int column = 0; column < map.columns; ++column)
    for (int row = 0; row < map.rows; ++row)
      if (column < 2 || row < 2 || column >= map.columns - 2 || row >= map.rows - 2)
        map.cells[map.index({column, row})] = OccupancyMap::occupied;
  return map;
}

DepthMount mount() {
  DepthMount mount{
      .camera =
          {.width_px = 640, .height_px = 480, .fx_px = 385.0, .fy_px = 385.0, .cx_px = 320.0, .cy_px = 240.0},
      .range_m = 3.5};
  mount.base_from_camera.translation() = Vec3(0.2, 0.0, 0.5);
  mount.base_from_camera.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return mount;
}

const Overhang table{.low_m = {4.0, 2.5}, .high_m = {5.0, 3.5}, .bottom_m = 0.70, .top_m = 0.74};

class HeightSlabTest : public ::testing::Test {
 protected:
  /// Images from this pose, a tenth of a second apart; the rays of the last.
  DeskewedScan look(const Pose2& at, const std::vector<Overhang>& overhangs, int images = 1,
                    const std::vector<DiscState>& discs = {}) {
    DeskewedScan seen;
    for (int i = 0; i < images; ++i) {
      SimulatedDepthCamera camera(hall(), overhangs, {.mount = mount()}, ++seed_);
      now_ += std::chrono::milliseconds(100);
      camera.observe(now_, at, discs);
      camera.observe(now_ + std::chrono::milliseconds(60), at, discs);
      const std::optional<DepthImage> image = camera.poll();
      EXPECT_TRUE(image.has_value());
      if (image) seen = slab_.add(*image, at);
    }
    return seen;
  }

  /// The range in this direction; the camera's where it sees through, nothing where it knows nothing.
  static std::optional<double> range_m(const DeskewedScan& scan, double direction_rad) {
    for (const Ray& ray : scan.rays) {
      const Vec2 way = ray.end_m - ray.origin_m;
      if (std::abs(wrap_angle(std::atan2(way.y(), way.x()) - direction_rad)) <= radians(0.51))
        return way.norm();
    }
    return std::nullopt;
  }

  HeightSlab slab_{mount(), OwnOutline{.shape = RobotShape(0.25)}, {}};
  Stamp now_;
  std::uint64_t seed_ = 0;
};

TEST_F(HeightSlabTest, shows_a_table_top_and_free_floor_beside_it) {
  const DeskewedScan seen = look({{2.0, 3.0}, 0.0}, {table});
  EXPECT_NEAR(range_m(seen, 0.0).value(), 1.8, 0.1);
  EXPECT_NEAR(range_m(seen, radians(30.0)).value(), 3.5, 1e-6);
  EXPECT_NEAR(range_m(seen, radians(-30.0)).value(), 3.5, 1e-6);
  for (const Ray& ray : seen.rays) EXPECT_NE(ray.echo, Echo::too_near);
}

TEST_F(HeightSlabTest, shows_neither_the_floor_nor_what_hangs_higher_than_the_robot) {
  const Overhang lamp{.low_m = {4.0, 2.5}, .high_m = {5.0, 3.5}, .bottom_m = 1.4, .top_m = 1.6};
  for (const Ray& ray : look({{2.0, 3.0}, 0.0}, {lamp}, 3).rays) EXPECT_EQ(ray.echo, Echo::nothing);
}

TEST_F(HeightSlabTest, keeps_an_edge_that_has_come_too_near_for_the_image) {
  for (double x_m = 2.0; x_m < 3.65; x_m += 0.1) look({{x_m, 3.0}, 0.0}, {table});
  const DeskewedScan seen = look({{3.7, 3.0}, 0.0}, {table});  // the edge is 0.1 m ahead, and 63 degrees up
  EXPECT_LT(range_m(seen, 0.0).value(), 0.2);
}

TEST_F(HeightSlabTest, forgets_what_images_look_through) {
  look({{2.0, 3.0}, 0.0}, {table}, 5);
  EXPECT_LT(range_m(look({{2.0, 3.0}, 0.0}, {}, 1), 0.0).value(), 2.0) << "one may be wrong";
  EXPECT_NEAR(range_m(look({{2.0, 3.0}, 0.0}, {}, 10), 0.0).value(), 3.5, 1e-6);
}

TEST_F(HeightSlabTest, forgets_after_a_while_what_nothing_is_seen_behind) {
  look({{2.0, 3.0}, 0.0}, {table}, 5);
  const DepthImage dark{.stamp = now_ + std::chrono::seconds(31),
                        .depth_mm = cv::Mat::zeros(480, 640, CV_16UC1)};
  EXPECT_THAT(slab_.add(dark, {{2.0, 3.0}, 0.0}).rays, ::testing::IsEmpty());
}

TEST_F(HeightSlabTest, sees_the_body_over_the_legs) {
  const DiscState person{.radius_m = 0.25, .has_legs = true, .position_m = {4.0, 3.0}};
  EXPECT_NEAR(range_m(look({{2.0, 3.0}, 0.0}, {}, 1, {person}), 0.0).value(), 1.55, 0.1);
}

TEST_F(HeightSlabTest, leaves_the_robot_itself_out) {
  const Overhang own_arm{.low_m = {2.0, 2.9}, .high_m = {2.22, 3.1}, .bottom_m = 0.2, .top_m = 0.9};
  DepthMount behind = mount();
  behind.base_from_camera.translation().x() = -0.6;
  HeightSlab slab(behind, OwnOutline{.shape = RobotShape(0.25)}, {});
  SimulatedDepthCamera camera(hall(), std::vector{own_arm}, {.mount = behind}, 1);
  camera.observe(Stamp{}, {{2.0, 3.0}, 0.0}, {});
  camera.observe(Stamp(std::chrono::milliseconds(60)), {{2.0, 3.0}, 0.0}, {});
  for (const Ray& ray : slab.add(*camera.poll(), {{2.0, 3.0}, 0.0}).rays) EXPECT_EQ(ray.echo, Echo::nothing);
}

}  // namespace
}  // namespace lodestar
