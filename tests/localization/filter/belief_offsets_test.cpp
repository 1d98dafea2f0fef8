#include "localization/filter/belief_offsets.hpp"

#include <gtest/gtest.h>

#include "tests/localization/rolling_world.hpp"

namespace lodestar {
namespace {

using namespace testing;

/// A row of markers, each off by its own part of 10 mm and 1 degree, as measured by tape.
class MarkerRow {
 public:
  static constexpr int count = 12;

  explicit MarkerRow(Random& random) {
    for (Vec3& offset : in_sigmas_) offset = Vec3(random.normal(), random.normal(), random.normal());
  }

  /// By the two markers nearest to the robot, each of which moves the pose by half of its offset, and turns
  /// it about itself by half of its turn.
  [[nodiscard]] PlanarFix seen_from(const Pose2& robot, Random& random) const {
    PlanarFix fix{.map_from_base = robot};
    fix.covariance = Vec3(square(own_m), square(own_m), square(own_rad)).asDiagonal();
    Vec3 error(own_m * random.normal(), own_m * random.normal(), own_rad * random.normal());
    const int first = std::clamp(static_cast<int>(std::floor(robot.position_m.x())), 0, count - 2);
    for (const int id : {first, first + 1}) {
      const Vec2 arm_m = robot.position_m - Vec2(id, 0.8);
      Eigen::Matrix<double, 3, 5> jacobian = Eigen::Matrix<double, 3, 5>::Zero();
      jacobian.leftCols<3>() << 0.01, 0.0, -arm_m.y() * radians(1.0), 0.0, 0.01, arm_m.x() * radians(1.0),
          0.0, 0.0, radians(1.0);
      jacobian *= 0.5;
      error += jacobian.leftCols<3>() * in_sigmas_.at(static_cast<std::size_t>(id));
      fix.shared_covariance += jacobian * jacobian.transpose();
      fix.by_offsets.push_back({id, jacobian});
      fix.ids.push_back(id);
    }
    fix.covariance += fix.shared_covariance;
    fix.map_from_base.position_m += error.head<2>();
    fix.map_from_base.yaw_rad += error.z();
    return fix;
  }

 private:
  static constexpr double own_m = 0.001;
  static constexpr double own_rad = radians(0.05);

  std::array<Vec3, count> in_sigmas_;
};

struct Drive {
  World world;
  Belief belief;
};

/// Along the row at 0.5 m/s, with 25 fixes a second.
Drive driven(double way_m, std::uint64_t seed) {
  const PoseFilterOptions options = without_floor();
  Drive drive{.world = {.truth = {{0.5, 0.1}, 0.0}, .noise_m_per_sqrt_m = 0.002, .random = Random(seed)},
              .belief = {}};
  const MarkerRow row(drive.world.random);
  drive.belief =
      belief_from(row.seen_from(drive.world.truth, drive.world.random), {}, initial_scales(options), options);
  const int steps = static_cast<int>(way_m / 0.02);
  for (int i = 1; i <= steps; ++i) {
    drive.world.roll(0.02, 0.02, 0.04 * i);
    drive.belief = moved(drive.belief, drive.world.reported, options);
    drive.belief = corrected(drive.belief, row.seen_from(drive.world.truth, drive.world.random), options);
  }
  return drive;
}

/// Counted as one error that is forgotten within a metre, those of the same two markers averaged each other
/// away: the squared error was 4.3 after 2 m, and 4.6 after 8 m.
TEST(BeliefOffsets, leave_the_pose_as_uncertain_as_it_is) {
  for (const double way_m : {0.4, 2.0, 8.0}) {
    constexpr int drives = 200;
    double mean = 0.0;
    for (int i = 0; i < drives; ++i) {
      const Drive drive = driven(way_m, static_cast<std::uint64_t>(i));
      mean +=
          nees(drive.world, drive.belief.map_from_base(), pose_covariance(drive.belief, without_floor())) /
          drives;
    }
    // Three degrees of freedom: the mean of 200 has a standard deviation of 0.17.
    EXPECT_NEAR(mean, 3.0, 0.7) << "after " << way_m << " m";
  }
}

TEST(BeliefOffsets, are_of_the_markers_used_last) {
  const Drive drive = driven(10.0, 1);
  ASSERT_EQ(drive.belief.offsets.size(), std::size_t{Belief::most_offsets});
  EXPECT_EQ(drive.belief.mean.size(), Belief::most_states);
  for (const RecentOffset& offset : drive.belief.offsets)
    EXPECT_GE(offset.id, MarkerRow::count - Belief::most_offsets);
}

TEST(BeliefOffsets, forgotten_leave_the_rest_as_it_was) {
  const PoseFilterOptions options = without_floor();
  Belief belief = driven(6.5, 1).belief;  // by eight markers
  PlanarFix by_another{.map_from_base = belief.map_from_base()};
  by_another.covariance = 1e6 * Eigen::Matrix3d::Identity();  // carries no information
  by_another.by_offsets = {{99, Eigen::Matrix<double, 3, 5>::Zero()}};
  by_another.ids = {99};
  ASSERT_EQ(belief.offsets.size(), std::size_t{Belief::most_offsets});
  const Belief after = corrected(belief, by_another, options);
  EXPECT_EQ(after.offsets.size(), belief.offsets.size());
  EXPECT_EQ(after.offsets.back().id, 99);
  constexpr Eigen::Index others = Belief::most_states - Belief::own_states - Belief::states_of_offset;
  // The least recently used was the first.
  EXPECT_LT((after.mean.segment(Belief::own_states, others) - belief.mean.tail(others)).norm(), 1e-6);
  EXPECT_LT((after.covariance.block(0, Belief::own_states, 3, others) -
             belief.covariance.block(0, Belief::own_states + Belief::states_of_offset, 3, others))
                .norm(),
            1e-9);
  EXPECT_LT((pose_covariance(after, options) - pose_covariance(belief, options)).norm(), 1e-9);
}

}  // namespace
}  // namespace lodestar
