#include "app/live/operator_session.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/navigation/navigation_setup.hpp"
#include "app/simulate/simulated_drive.hpp"
#include "drivers/system/clock.hpp"

// Operators at the console and a simulated robot: what they request, and what it does.
namespace lodestar {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

Site lab() {
  return load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
}

constexpr Duration long_time = std::chrono::hours(1);

/// All published states, and the recorded drives.
struct Story {
  std::vector<RobotState> states;
  std::vector<RunRecord> kept;

  [[nodiscard]] bool said(const std::string& words) const {
    return std::ranges::any_of(states.back().events, [&](const DriveEvent& event) {
      return event.words.find(words) != std::string::npos;
    });
  }
};

/// `tell` is called before each step with the story so far, and gives orders; the story ends when it returns
/// false, or after 20 000 steps.
Story attended(const Site& site, const std::vector<Goal>& goals,
               const std::function<bool(LiveLink&, const Story&)>& tell) {
  LiveLink link;
  OperatorSession session(link);
  Story story;
  int steps = 0;
  const auto goes_on = [&] {
    if (auto state = link.newest()) story.states.push_back(std::move(*state));
    link.want_state();
    return tell(link, story) && ++steps < 20'000;
  };
  simulate_attended_drive(site, {.camera = site.default_camera, .goals = goals}, session, goes_on,
                          [&](RunRecord record) { story.kept.push_back(std::move(record)); });
  EXPECT_LT(steps, 20'000) << "the drive does not end";
  return story;
}

Order go_to(const Vec2& place) {
  return {.by = "somebody", .what = GoOrder{{{.position_m = place, .heading_rad = {}}}}};
}

bool is_idle(const Story& story) {
  return !story.states.empty() && story.states.back().phase == MissionPhase::idle;
}

bool drives_fast(const Story& story) {
  return !story.states.empty() && story.states.back().measured.value_or(BodyVelocity{}).forward_mps > 0.4;
}

/// Expects that from this state on no command exceeds the robot's acceleration limit.
void expect_gentle(const Story& story, const Site& site, std::size_t from) {
  for (std::size_t i = std::max<std::size_t>(from, 1); i < story.states.size(); ++i) {
    const double elapsed_s = seconds(story.states[i].now - story.states[i - 1].now);
    const double change = story.states[i].commanded.forward_mps - story.states[i - 1].commanded.forward_mps;
    EXPECT_LE(std::abs(change), site.robot.max_acceleration_mps2 * elapsed_s + 1e-9) << "state " << i;
  }
}

TEST(OperatorSession, appends_goals_to_the_drive_and_begins_one_where_there_is_none) {
  const Site site = lab();
  const Vec2 second_m{2.2, 5.2};
  bool told = false;
  const Story story = attended(site, {{.position_m = {2.0, 5.6}}}, [&](LiveLink& link, const Story& so_far) {
    link.hold_until(monotonic_now() + long_time);
    if (!told && drives_fast(so_far)) {
      Order order = go_to(second_m);
      std::get<GoOrder>(order.what).is_more = true;
      told = link.give(order);
    }
    return !told || !is_idle(so_far);
  });
  ASSERT_EQ(story.kept.size(), 1U);
  ASSERT_EQ(story.kept.front().goals.size(), 2U);
  EXPECT_TRUE(story.kept.front().arrived()) << story.kept.front().goals.back().failure;
  EXPECT_EQ(story.kept.front().goals.back().goal.position_m, second_m);
  EXPECT_TRUE(story.said("somebody: then go to (2.20, 5.20)"));

  told = false;
  const Story alone = attended(site, {}, [&](LiveLink& link, const Story& so_far) {
    link.hold_until(monotonic_now() + long_time);
    if (!told && !so_far.states.empty() && so_far.states.back().base == BaseState::ready) {
      Order order = go_to({1.8, 5.6});
      std::get<GoOrder>(order.what).is_more = true;
      told = link.give(order);
    }
    return so_far.kept.empty();
  });
  EXPECT_TRUE(alone.kept.front().arrived());
}

TEST(OperatorSession, sends_the_robot_where_it_is_told_and_keeps_each_drive) {
  const Site site = lab();
  bool told = false;
  const Story story = attended(site, {{.position_m = {1.7, 5.6}, .heading_rad = {}}},
                               [&](LiveLink& link, const Story& so_far) {
                                 link.hold_until(monotonic_now() + long_time);
                                 if (!told && is_idle(so_far)) told = link.give(go_to({2.2, 5.0}));
                                 return so_far.kept.size() < 2;
                               });
  ASSERT_EQ(story.kept.size(), 2U);
  EXPECT_TRUE(story.kept[0].arrived());
  EXPECT_TRUE(story.kept[1].arrived());
  EXPECT_EQ(story.kept[1].goals.front().goal.position_m, Vec2(2.2, 5.0));
  EXPECT_LT(story.kept[1].score_of(0)->position_error_m, 0.02);
  // The second record begins where the first ended.
  EXPECT_LT((story.kept[1].start.position_m - story.kept[0].truth.back().map_from_base.position_m).norm(),
            0.005);
  EXPECT_TRUE(story.said("somebody: go to (2.20, 5.00)"));
}

/// The camera's frame is handed over without a copy or encoding: a client that wants an image encodes it.
/// States that nobody has fetched are replaced.
TEST(OperatorSession, hands_over_the_newest_frame_as_it_is_and_keeps_no_state_for_the_slow) {
  const Site site = lab();
  LiveLink link;
  OperatorSession session(link);
  SensorInput input;
  Mission mission(known_world(site, site.default_camera), navigation_options(site.robot), {});
  std::vector<cv::Mat> taken;
  for (int i = 1; i <= 3; ++i) {
    taken.emplace_back(480, 640, CV_8UC1, cv::Scalar(i));
    input.now = Stamp(std::chrono::milliseconds(20 * i));
    input.frames = {{.stamp = input.now, .gray = taken.back()}};
    link.want_state();
    session.publish(input, mission.step(input), mission, {});
  }
  const std::optional<RobotState> newest = link.newest();
  ASSERT_TRUE(newest && newest->frame);
  EXPECT_EQ(newest->frame->stamp, input.now);
  EXPECT_EQ(newest->frame->gray.data, taken.back().data);
  EXPECT_FALSE(link.newest()) << "older states are not queued";
}

TEST(OperatorSession, stops_within_the_limits_for_whoever_asks) {
  const Site site = lab();
  std::size_t stopped_at = 0;
  const Story story = attended(site, {{.position_m = {5.4, 4.3}, .heading_rad = {}}},
                               [&](LiveLink& link, const Story& so_far) {
                                 if (stopped_at == 0 && drives_fast(so_far)) {
                                   link.stop();
                                   stopped_at = so_far.states.size();
                                 }
                                 return so_far.kept.empty();
                               });
  ASSERT_GT(stopped_at, 0U);
  EXPECT_EQ(story.kept.front().goals.front().failure, "stopped by the operator");
  expect_gentle(story, site, stopped_at);
  EXPECT_LT(seconds(story.states.back().now - story.states[stopped_at].now), 2.0);
  EXPECT_NEAR(story.states.back().measured->forward_mps, 0.0, 0.003);
}

TEST(OperatorSession, pauses_when_nobody_is_at_the_wheel_any_more_and_goes_on_when_told) {
  const Site site = lab();
  bool told = false;
  bool resumed = false;
  std::size_t left_at = 0;
  const Story story = attended(site, {}, [&](LiveLink& link, const Story& so_far) {
    if (!told && is_idle(so_far) && so_far.states.back().estimate) told = link.give(go_to({3.2, 4.3}));
    if (left_at == 0 && drives_fast(so_far)) left_at = so_far.states.size();
    const bool stands = left_at > 0 && so_far.states.back().phase == MissionPhase::paused &&
                        so_far.states.back().commanded.forward_mps == 0.0;
    if (stands && !resumed) resumed = link.give({.by = "another", .what = ResumeOrder{}});
    link.hold_until(left_at == 0 || resumed ? monotonic_now() + long_time : Stamp{});
    return so_far.kept.empty();
  });
  EXPECT_TRUE(resumed);
  EXPECT_TRUE(story.said("no client has control any more"));
  EXPECT_TRUE(story.kept.front().arrived()) << story.kept.front().goals.front().failure;
  expect_gentle(story, site, left_at);
}

TEST(OperatorSession, a_drive_of_the_command_line_needs_nobody_at_the_wheel) {
  const Site site = lab();
  const Story story = attended(site, {{.position_m = {1.9, 5.6}, .heading_rad = {}}},
                               [](LiveLink&, const Story& so_far) { return so_far.kept.empty(); });
  EXPECT_TRUE(story.kept.front().arrived());
}

TEST(OperatorSession, another_goal_ends_the_present_drive_gently_and_begins_the_next) {
  const Site site = lab();
  std::size_t told_at = 0;
  const Story story = attended(site, {{.position_m = {5.4, 4.3}, .heading_rad = {}}},
                               [&](LiveLink& link, const Story& so_far) {
                                 link.hold_until(monotonic_now() + long_time);
                                 if (told_at == 0 && drives_fast(so_far) && link.give(go_to({1.7, 5.6})))
                                   told_at = so_far.states.size();
                                 return so_far.kept.size() < 2;
                               });
  expect_gentle(story, site, told_at);
  EXPECT_FALSE(story.kept[0].arrived());
  EXPECT_TRUE(story.kept[1].arrived());
  EXPECT_EQ(story.kept[0].contacts + story.kept[1].contacts, 0);
}

TEST(OperatorSession, takes_somebodys_word_for_where_the_robot_stands_until_markers_tell_more) {
  const Site site = lab();
  bool told = false;
  const Pose2 said = site.start * Pose2{Vec2(0.1, 0.05), radians(4.0)};
  std::size_t unsure = 0;
  const Story story = attended(site, {}, [&](LiveLink& link, const Story& so_far) {
    if (!told && is_idle(so_far) && so_far.states.back().estimate) {
      told = link.give({.by = "somebody", .what = PlaceOrder{said}});
    }
    if (told && so_far.states.back().stop == StopReason::pose_uncertain) ++unsure;
    return so_far.states.empty() || seconds(so_far.states.back().now) < 2.5;
  });
  EXPECT_GT(unsure, 0U);
  EXPECT_EQ(story.states.back().stop, std::nullopt);
  EXPECT_LT((story.states.back().estimate->map_from_base.position_m - site.start.position_m).norm(), 0.02);
  EXPECT_THAT(story.kept, IsEmpty());
}

/// Steered for two seconds; then no order comes any more.
TEST(OperatorSession, steers_by_hand_while_the_orders_are_renewed) {
  Site site = lab();
  site.registry.markers.clear();  // where it is, it never knows
  int orders = 0;
  std::size_t last_order = 0;
  const Story story = attended(site, {}, [&](LiveLink& link, const Story& so_far) {
    link.hold_until(monotonic_now() + long_time);
    const bool is_up = !so_far.states.empty() && so_far.states.back().base == BaseState::ready;
    if (is_up && orders < 100) {
      EXPECT_TRUE(link.give({.by = "somebody", .what = SteerOrder{{0.25, 0.0}}}));
      ++orders;
      last_order = so_far.states.size();
    }
    return so_far.states.size() < last_order + 100 || orders < 100;
  });
  EXPECT_TRUE(story.said("somebody: drive by hand"));
  EXPECT_EQ(story.states[last_order].phase, MissionPhase::by_hand);
  EXPECT_NEAR(story.states[last_order].measured->forward_mps, 0.25, 0.02);
  EXPECT_EQ(story.states.back().phase, MissionPhase::idle);
  EXPECT_NEAR(story.states.back().measured->forward_mps, 0.0, 0.003);
  expect_gentle(story, site, 1);
}

TEST(OperatorSession, ends_a_drive_before_it_steers_and_stop_ends_steering) {
  const Site site = lab();
  bool has_stopped = false;
  bool was_by_hand = false;
  const Story story = attended(
      site, {{.position_m = {5.4, 4.3}, .heading_rad = {}}}, [&](LiveLink& link, const Story& so_far) {
        link.hold_until(monotonic_now() + long_time);
        if (so_far.kept.empty() && !drives_fast(so_far)) return true;
        was_by_hand = was_by_hand || so_far.states.back().phase == MissionPhase::by_hand;
        if (so_far.kept.empty() || !was_by_hand) {
          EXPECT_TRUE(link.give({.by = "somebody", .what = SteerOrder{{0.0, 0.3}}}));
        } else if (!has_stopped) {
          link.stop();
          has_stopped = true;
        }
        return !has_stopped || so_far.states.back().phase != MissionPhase::idle;
      });
  ASSERT_EQ(story.kept.size(), 1U);
  EXPECT_EQ(story.kept.front().goals.front().failure, "stopped by the operator");
  EXPECT_TRUE(was_by_hand);
  expect_gentle(story, site, 1);
}

}  // namespace
}  // namespace lodestar
