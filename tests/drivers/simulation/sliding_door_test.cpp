#include "drivers/simulation/sliding_door.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "drivers/simulation/simulation.hpp"

#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

using namespace std::chrono_literals;

constexpr Duration step = 10ms;
const SlidingDoor door{.from_m = {4.0, 1.0}, .to_m = {4.0, 2.2}, .shuts = 1s, .opens = 10s};

/// How far the leaf is out of the wall, with its edge.
double out_m(const SlidingLeaf& leaf) {
  double farthest_m = -1.0;
  for (const DiscState& disc : leaf.discs())
    farthest_m = std::max(farthest_m, disc.position_m.y() + disc.radius_m - door.from_m.y());
  return farthest_m;
}

void step_until(SlidingLeaf& leaf, Stamp& now, Stamp end, const std::vector<Vec2>& present_m = {}) {
  for (; now < end; now += step) leaf.step(now, step, present_m);
}

TEST(SlidingDoor, shuts_from_post_to_post_and_opens_again) {
  SlidingLeaf leaf(door);
  Stamp now;
  EXPECT_NEAR(out_m(leaf), 0.0, 1e-9) << "in the wall at first";
  step_until(leaf, now, Stamp(9s));
  std::vector<double> places_m;
  for (const DiscState& disc : leaf.discs()) {
    EXPECT_EQ(disc.position_m.x(), 4.0);
    places_m.push_back(disc.position_m.y());
  }
  const double radius_m = leaf.discs().front().radius_m;
  EXPECT_NEAR(places_m.front() + radius_m, 1.0, 1e-9);
  EXPECT_NEAR(places_m.back() + radius_m, 2.2, 1e-9);
  for (std::size_t i = 1; i < places_m.size(); ++i)
    EXPECT_LT(places_m[i] - places_m[i - 1], 2.0 * radius_m) << "no beam passes";
  step_until(leaf, now, Stamp(15s));
  EXPECT_NEAR(out_m(leaf), 0.0, 1e-9);
}

/// What stands is passed as if it could start with 1 m/s^2 (ProtectiveFieldOptions).
TEST(SlidingDoor, starts_and_ends_at_rest) {
  SlidingLeaf leaf(door);
  double before_m = 0.0;
  double before_mps = 0.0;
  double fastest_mps = 0.0;
  for (Stamp now; now < Stamp(15s); now += step) {
    leaf.step(now, step, {});
    const double speed_mps = (out_m(leaf) - before_m) / seconds(step);
    EXPECT_LE(std::abs(speed_mps), 0.501);
    const bool has_met_its_end = std::abs(speed_mps) < 0.08;
    EXPECT_TRUE(has_met_its_end || std::abs(speed_mps - before_mps) <= 0.0101) << seconds(now);
    EXPECT_NEAR(leaf.discs().back().velocity_mps.y(), speed_mps, 0.08) << "as the scanner is told";
    fastest_mps = std::max(fastest_mps, speed_mps);
    before_m = out_m(leaf);
    before_mps = speed_mps;
  }
  EXPECT_NEAR(fastest_mps, 0.5, 0.001);
}

TEST(SlidingDoor, opens_while_someone_is_in_the_doorway_and_shuts_after_them) {
  SlidingLeaf leaf(door);
  Stamp now;
  step_until(leaf, now, Stamp(2500ms));
  const double half_shut_m = out_m(leaf);
  EXPECT_GT(half_shut_m, 0.3);
  step_until(leaf, now, Stamp(5s), {{4.5, 1.6}});
  EXPECT_NEAR(out_m(leaf), 0.0, 1e-9);
  step_until(leaf, now, Stamp(9s), {{6.0, 1.6}});
  EXPECT_NEAR(out_m(leaf), 1.2, 1e-9) << "who has gone on keeps it no longer";
}

TEST(SlidingDoor, stays_shut_for_whoever_stands_before_it) {
  SlidingLeaf leaf(door);
  Stamp now;
  step_until(leaf, now, Stamp(6s));
  step_until(leaf, now, Stamp(9s), {{4.5, 1.6}});
  EXPECT_NEAR(out_m(leaf), 1.2, 1e-9);
}

TEST(SlidingDoor, of_the_simulated_world_shuts_for_the_robot_only_where_it_is_not) {
  CameraModel camera;
  camera.width_px = 64;
  camera.height_px = 48;
  camera.fx_px = camera.fy_px = 32.0;
  const auto out_beside_m = [&](const Vec2& robot_m) {
    SimulationOptions options;
    options.start.position_m = robot_m;
    options.doors = {door};
    Simulation simulation(empty_floor(160, 80, 0.05), {}, camera, options);
    simulation.advance(5s);
    const DiscState edge = simulation.discs().back();
    return edge.position_m.y() + edge.radius_m - door.from_m.y();
  };
  EXPECT_NEAR(out_beside_m({4.0, 1.6}), 0.0, 1e-9);
  EXPECT_NEAR(out_beside_m({6.0, 1.6}), 1.2, 1e-9);
}

}  // namespace
}  // namespace lodestar
