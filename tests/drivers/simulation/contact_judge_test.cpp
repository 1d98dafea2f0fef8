#include "drivers/simulation/contact_judge.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "tests/maps/empty_floor.hpp"

namespace lodestar {
namespace {

constexpr double robot_m = 0.25;
constexpr double disc_m = 0.3;

/// 12 m x 8 m.
OccupancyMap hall() {
  return empty_floor(240, 160, 0.05);
}

/// The hall with a wall at x = 6 m from the floor's edge up to a row of cells of 5 cm.
OccupancyMap with_corner(int end_row) {
  OccupancyMap map = hall();
  for (int row = 0; row < end_row; ++row) map.cells[map.index({120, row})] = OccupancyMap::occupied;
  return map;
}

/// Judges a robot and one disc that both move as the functions of the time in seconds say.
template <typename Robot, typename Disc>
ContactScore judged(const OccupancyMap& map, double until_s, Robot robot, Disc disc,
                    const ContactJudgeOptions& options = {}) {
  ContactJudge judge(map, robot_m, std::nullopt, options);
  for (int i = 0; 0.01 * i <= until_s; ++i) {
    const double now_s = 0.01 * i;
    const DiscState state{.radius_m = disc_m, .position_m = disc(now_s)};
    judge.record(Stamp(from_seconds(now_s)), robot(now_s), std::vector{state});
  }
  return judge.score();
}

const auto standing = [](double) { return Pose2{{3.0, 4.0}, 0.0}; };
const auto driving = [](double s) { return Pose2{{3.0 + 0.5 * s, 4.0}, 0.0}; };

TEST(ContactJudge, counts_a_contact_once_from_touch_to_release) {
  // The robot drives at 0.5 m/s through a disc that stands 2 m ahead: touch after 2.9 s, release after 5.1 s.
  const ContactScore score = judged(hall(), 8.0, driving, [](double) { return Vec2(5.0, 4.0); });
  EXPECT_EQ(score.moving, 1);
  EXPECT_EQ(score.excused, 0);
  EXPECT_EQ(score.at_rest, 0);
  EXPECT_NEAR(score.greatest_contact_mps, 0.5, 0.01);
  EXPECT_NEAR(*score.least_clearance_m, -(robot_m + disc_m), 0.01);
}

TEST(ContactJudge, does_not_blame_a_robot_that_stands) {
  const ContactScore score = judged(hall(), 8.0, standing, [](double s) { return Vec2(6.0 - 1.0 * s, 4.0); });
  EXPECT_EQ(score.moving + score.excused, 0);
  EXPECT_EQ(score.at_rest, 1);
  EXPECT_EQ(score.greatest_contact_mps, 0.0);
}

TEST(ContactJudge, blames_a_robot_that_moves_off_while_it_is_touched) {
  const ContactScore score = judged(
      hall(), 4.0, [](double s) { return Pose2{{3.0 + std::max(0.0, 0.2 * (s - 2.0)), 4.0}, 0.0}; },
      [](double s) { return Vec2(std::max(3.4, 4.5 - 1.0 * s), 4.0); });
  EXPECT_EQ(score.moving, 1);
  EXPECT_EQ(score.at_rest, 0) << "it is the same event";
}

TEST(ContactJudge, calls_turning_on_the_spot_moving_when_the_edge_moves) {
  const auto touching = [](double s) { return Vec2(std::max(3.5, 5.0 - 1.0 * s), 4.0); };
  const auto turning = [](double radps) {
    return [radps](double s) { return Pose2{{3.0, 4.0}, wrap_angle(radps * s)}; };
  };
  EXPECT_EQ(judged(hall(), 3.0, turning(0.06), touching).moving, 1) << "15 mm/s at the edge";
  EXPECT_EQ(judged(hall(), 3.0, turning(0.03), touching).at_rest, 1) << "7.5 mm/s";
}

TEST(ContactJudge, excuses_people_who_were_faster_than_two_metres_a_second) {
  const auto coming_at = [](double mps) { return [mps](double s) { return Vec2(11.0 - mps * s, 4.0); }; };
  EXPECT_EQ(judged(hall(), 3.0, driving, coming_at(2.0)).moving, 1);
  EXPECT_EQ(judged(hall(), 3.0, driving, coming_at(2.1)).excused, 1);
  // The run was over 1.3 s before the contact, or 1.1 s: after 2 m at 4 m/s a walk at 1 m/s.
  const auto ran = [](double walk_m) {
    return [walk_m](double s) {
      const double run_s = 0.5;
      return Vec2(3.55 + walk_m + (s < run_s ? 4.0 * (run_s - s) : -1.0 * (s - run_s)), 4.0);
    };
  };
  const auto creeping = [](double s) { return Pose2{{3.0 + 0.02 * s, 4.0}, 0.0}; };
  EXPECT_EQ(judged(hall(), 3.0, creeping, ran(1.3)).moving, 1);
  EXPECT_EQ(judged(hall(), 3.0, creeping, ran(1.1)).excused, 1);
}

TEST(ContactJudge, excuses_who_steps_out_from_behind_a_corner_too_late_to_brake) {
  // The robot passes the end of a wall, 5 cm away from it; a disc close behind the wall comes across.
  const auto passing = [](double s) { return Pose2{{4.0 + 0.5 * s, 4.0}, 0.0}; };
  const auto steps_out_at = [](double begin_s) {
    return [begin_s](double s) { return Vec2(6.35, std::min(4.0, 2.0 + 1.9 * std::max(0.0, s - begin_s))); };
  };
  const ContactScore late = judged(with_corner(74), 5.0, passing, steps_out_at(2.77));
  EXPECT_EQ(late.excused, 1);
  EXPECT_EQ(late.moving, 0);
  const ContactScore early = judged(with_corner(74), 6.0, passing, steps_out_at(0.5));
  EXPECT_EQ(early.moving, 1) << "it had stood in the way for seconds";
  EXPECT_EQ(early.excused, 0);
  EXPECT_EQ(judged(hall(), 5.0, passing, steps_out_at(2.77)).moving, 1) << "nothing hid it";
}

TEST(ContactJudge, does_not_take_a_kidnapping_for_driving) {
  const auto carried = [](double s) { return Pose2{{s < 2.0 ? 3.0 : 7.0 + 0.2 * (s - 2.0), 4.0}, 0.0}; };
  const ContactScore score = judged(hall(), 3.0, carried, [](double) { return Vec2(7.2, 4.0); });
  EXPECT_EQ(score.moving, 0);
  EXPECT_EQ(score.excused, 1) << "it was set down upon somebody, and had no time to brake";
  EXPECT_NEAR(score.greatest_contact_mps, 0.2, 0.01);
}

TEST(ContactJudge, does_not_see_beyond_the_scanner_s_range) {
  const auto coming = [](double s) { return Vec2(11.0 - 1.9 * s, 4.0); };
  EXPECT_EQ(judged(hall(), 4.0, driving, coming, {.range_m = 0.7}).excused, 1);
  EXPECT_EQ(judged(hall(), 4.0, driving, coming, {.range_m = 3.0}).moving, 1);
}

TEST(ContactJudge, measures_the_least_room_to_discs_and_to_the_map) {
  const auto far_away = [](double) { return Vec2(3.0, 7.5); };
  const ContactScore past_the_disc = judged(hall(), 8.0, driving, far_away);
  EXPECT_NEAR(*past_the_disc.least_clearance_m, 3.5 - robot_m - disc_m, 1e-9);
  const ContactScore past_the_wall = judged(with_corner(70), 10.0, driving, far_away);
  EXPECT_NEAR(*past_the_wall.least_clearance_m, 0.5 - robot_m, 1e-3);
}

TEST(ContactJudge, goes_by_the_footprint) {
  // 1 m long and 0.2 m wide.
  const Footprint plank({{-0.5, -0.1}, {0.5, -0.1}, {0.5, 0.1}, {-0.5, 0.1}});
  const RobotClearance clearance(with_corner(70), robot_m, plank);
  EXPECT_NEAR(clearance.to_disc_m({{3.0, 4.0}, 0.0}, {4.0, 4.0}, 0.3), 0.2, 1e-12);
  EXPECT_NEAR(clearance.to_disc_m({{3.0, 4.0}, radians(90.0)}, {4.0, 4.0}, 0.3), 0.6, 1e-12);
  EXPECT_LT(clearance.to_disc_m({{3.0, 4.0}, 0.0}, {3.0, 4.2}, 0.3), 0.0);
  EXPECT_NEAR(*clearance.to_map_m({{5.0, 3.0}, 0.0}, 10.0), 0.5, 1e-9);
  EXPECT_NEAR(*clearance.to_map_m({{5.0, 3.0}, radians(90.0)}, 10.0), 0.9, 1e-9);
  EXPECT_EQ(clearance.to_map_m({{5.6, 3.0}, 0.0}, 10.0), 0.0);
  EXPECT_FALSE(clearance.to_map_m({{5.0, 3.0}, 0.0}, 0.4));
}

}  // namespace
}  // namespace lodestar
