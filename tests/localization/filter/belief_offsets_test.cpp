#include "localization/filter/belief_offsets.hpp"

#include <gtest/gtest.h>

#include "tests/localization/rolling_world.hpp"

namespace lodestar {
namespace {

using namespace testing;

/// A row of markers, each off by its own part of 10 mm and 1 degree, as measured by tape; or by so many times
/// as much.
class MarkerRow {
 public:
  static constexpr int count = 12;

  explicit MarkerRow(Random& random, double times = 1.0) {
    for (Vec3& offset : in_sigmas_) offset = times * Vec3(random.normal(), random.normal(), random.normal());
  }

  void move_marker(int id, const Vec3& by_sigmas) {
    in_sigmas_.at(static_cast<std::size_t>(id)) += by_sigmas;
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
Drive driven(double way_m, std::uint64_t seed, const PoseFilterOptions& options = without_floor()) {
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

TEST(BeliefOffsets, of_another_prior_are_as_if_it_had_been_so_from_the_beginning) {
  PoseFilterOptions of_worse = without_floor();
  of_worse.registry_variance = 9.0;
  const Belief belief = driven(4.0, 1).belief;
  const Belief worse = driven(4.0, 1, of_worse).belief;
  const Belief made_worse = with_registry_variance(belief, 9.0);
  const Eigen::Matrix3d wanted = pose_covariance(worse, of_worse);
  const Eigen::Matrix3d found = pose_covariance(made_worse, of_worse);
  // But for where the corrections are linearized.
  EXPECT_LT((found - wanted).norm(), 0.05 * wanted.norm());
  EXPECT_LT((made_worse.mean - worse.mean).head<3>().norm(), 0.002);
  EXPECT_GT(found(0, 0), 3.0 * pose_covariance(belief, without_floor())(0, 0));
  const Belief back = with_registry_variance(made_worse, 1.0);
  EXPECT_LT((back.mean - belief.mean).norm(), 1e-6);
  EXPECT_LT((back.covariance - belief.covariance).norm(), 1e-6);
}

struct Filtered {
  World world;
  PoseFilter filter{without_floor()};
};

/// As driven(), by a filter, which may refuse a fix, and begins with what an earlier drive has learned.
Filtered filtered(double way_m, std::uint64_t seed, double times, const Vec3& moved_by_sigmas = Vec3::Zero(),
                  double learned = 1.0) {
  constexpr int moved_marker = 3;
  PoseFilterOptions options = without_floor();
  options.registry_variance = learned;
  Filtered drive{.world = {.truth = {{0.5, 0.1}, 0.0}, .noise_m_per_sqrt_m = 0.002, .random = Random(seed)},
                 .filter = PoseFilter(options)};
  MarkerRow row(drive.world.random, times);
  row.move_marker(moved_marker, moved_by_sigmas);
  const int steps = static_cast<int>(way_m / 0.02);
  for (int i = 1; i <= steps; ++i) {
    drive.world.roll(0.02, 0.02, 0.04 * i);
    drive.filter.add_travel(drive.world.reported);
    PlanarFix fix = row.seen_from(drive.world.truth, drive.world.random);
    fix.stamp = drive.world.reported.stamp;
    drive.filter.add_fix(fix);
  }
  return drive;
}

/// Drives in a hundred, after which the registry is thought worse than it says.
int drives_with_doubt(double times, const Vec3& moved_by_sigmas = Vec3::Zero()) {
  int doubting = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    doubting += filtered(8.0, seed, times, moved_by_sigmas).filter.registry_variance() > 1.0 ? 1 : 0;
  return doubting;
}

TEST(RegistryVariance, is_that_of_a_registry_worse_than_it_says) {
  EXPECT_GE(drives_with_doubt(3.0), 95);
}

TEST(RegistryVariance, of_a_registry_that_tells_the_truth_stays) {
  EXPECT_LE(drives_with_doubt(1.0), 3);
  EXPECT_EQ(drives_with_doubt(0.0), 0);
}

TEST(RegistryVariance, is_not_doubted_for_one_marker_that_was_moved) {
  EXPECT_LE(drives_with_doubt(1.0, Vec3(8.0, -6.0, 5.0)), 5);
}

/// Taken at its word, the squared error of the estimate was 29.
TEST(RegistryVariance, keeps_the_estimate_as_uncertain_as_it_is) {
  constexpr int drives = 200;
  double mean = 0.0;
  for (int i = 0; i < drives; ++i) {
    const Filtered drive = filtered(8.0, static_cast<std::uint64_t>(i), 3.0);
    mean += nees(drive.world, drive.filter) / drives;
  }
  EXPECT_LT(mean, 6.0);
}

/// Before three markers have been seen there is nothing to learn from.
TEST(RegistryVariance, of_an_earlier_drive_keeps_the_beginning_of_the_next_as_uncertain_as_it_is) {
  constexpr int drives = 200;
  double learning = 0.0;
  double knowing = 0.0;
  for (int i = 0; i < drives; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const Filtered first = filtered(1.5, seed, 3.0);
    learning += nees(first.world, first.filter) / drives;
    const Filtered second = filtered(1.5, seed, 3.0, Vec3::Zero(), 8.0);
    knowing += nees(second.world, second.filter) / drives;
  }
  EXPECT_GT(learning, 8.0);
  EXPECT_LT(knowing, 4.5);
}

TEST(RegistryVariance, of_an_earlier_drive_is_unlearned_where_the_markers_are_in_their_places) {
  int doubting = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    doubting += filtered(8.0, seed, 0.0, Vec3::Zero(), 8.0).filter.registry_variance() > 1.0 ? 1 : 0;
  EXPECT_LE(doubting, 5);
}

}  // namespace
}  // namespace lodestar
