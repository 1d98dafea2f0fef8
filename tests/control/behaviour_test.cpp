#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "maps/random.hpp"

#include "tests/control/behaviours.hpp"

namespace lodestar {
namespace {

using Reason = Braking::Reason;

const BehaviourOptions options;

template <typename State>
bool is(const Behaviour& behaviour) {
  return std::holds_alternative<State>(behaviour.state);
}

/// The last commanded velocity.
BodyVelocity velocity_of(const Behaviour& behaviour) {
  const Trip* const trip = trip_of(behaviour.state);
  if (trip == nullptr) return {};
  RotateThenDrive drive = trip->drive;
  if (const auto* backtracking = std::get_if<Backtracking>(&behaviour.state)) drive = backtracking->way;
  const auto* paused = std::get_if<Paused>(&behaviour.state);
  if (paused != nullptr && paused->way_back) drive = *paused->way_back;
  return drive.slow_down(Duration::zero());  // zero elapsed time: no change
}

Moved step(const Behaviour& before, const Facts& facts) {
  return moved(decided(before, facts, options), facts, options);
}

std::vector<NamedFacts> all_happenings() {
  std::vector<NamedFacts> all = all_findings();
  for (const NamedFacts& wish : all_wishes()) all.push_back(wish);
  return all;
}

TEST(Behaviour, changes_no_speed_abruptly_whatever_happens_but_for_halts) {
  for (const NamedBehaviour& from : all_behaviours()) {
    for (const NamedFacts& happening : all_happenings()) {
      SCOPED_TRACE(from.name + ", " + happening.name);
      const BodyVelocity before = velocity_of(from.behaviour);
      const Moved after = step(from.behaviour, happening.facts);
      const double change_mps = std::abs(after.command.forward_mps - before.forward_mps);
      const double change_radps = std::abs(after.command.turn_radps - before.turn_radps);
      if (happening.name == "halt" || happening.name == "carried away") {
        EXPECT_EQ(after.command.forward_mps, 0.0);
        EXPECT_EQ(after.command.turn_radps, 0.0);
        continue;
      }
      EXPECT_LE(change_mps, options.drive.max_acceleration_mps2 * seconds(step_time) + 1e-12);
      EXPECT_LE(change_radps, options.drive.max_turn_acceleration_radps2 * seconds(step_time) + 1e-12);
    }
  }
}

TEST(Behaviour, comes_to_rest_whatever_it_was_about_when_it_is_stopped) {
  for (const NamedBehaviour& from : all_behaviours()) {
    for (const std::string name :
         {"too uncertain even to backtrack", "camera lost", "carried away", "pause", "cancel", "halt"}) {
      SCOPED_TRACE(from.name + ", " + name);
      Facts facts;
      for (const NamedFacts& happening : all_happenings())
        if (happening.name == name) facts = happening.facts;
      Moved last{velocity_of(from.behaviour), from.behaviour};
      for (int i = 0; i < 100; ++i) {
        const double forward_mps = last.command.forward_mps;
        last = step(last.behaviour, facts);
        EXPECT_LE(std::abs(last.command.forward_mps), std::abs(forward_mps));
        facts.now += step_time;
      }
      EXPECT_EQ(last.command.forward_mps, 0.0);
      EXPECT_LE(std::abs(last.command.turn_radps), options.spin.turn_radps);
    }
  }
}

/// Random facts in sequence, and a planner that answers requests after some steps.
class Story {
 public:
  Story(const Behaviour& begin, std::uint64_t seed) : random_(seed), behaviour_(begin) {}

  void step(Wish wish) {
    Facts facts = calm();
    facts.now = now_ += step_time;
    facts.wish = wish;
    if (random_.uniform() < 0.05) find_something();
    facts.stop = stop_;
    facts.stop_on_backtrack = stop_on_backtrack_;
    facts.sees_marker = sees_marker_;
    facts.room_ahead = room_;
    facts.map_changed = random_.uniform() < 0.02;
    facts.may_look_around = true;
    about_ = decided(behaviour_, facts, options);
    if (plan_wanted(about_.state) && random_.uniform() < 0.3) about_ = answered(about_, some_answer());
    const Moved after = moved(about_, facts, options);
    behaviour_ = after.behaviour;
    change_mps_ = std::abs(after.command.forward_mps - command_.forward_mps);
    change_radps_ = std::abs(after.command.turn_radps - command_.turn_radps);
    command_ = after.command;
  }

  [[nodiscard]] const Behaviour& about() const { return about_; }
  [[nodiscard]] const Behaviour& behaviour() const { return behaviour_; }
  [[nodiscard]] const BodyVelocity& command() const { return command_; }
  [[nodiscard]] double change_mps() const { return change_mps_; }
  [[nodiscard]] double change_radps() const { return change_radps_; }
  [[nodiscard]] bool may_move() const { return !stop_; }
  [[nodiscard]] bool may_go_back() const { return !stop_on_backtrack_; }

 private:
  void find_something() {
    const double what = random_.uniform();
    stop_.reset();
    stop_on_backtrack_.reset();
    sees_marker_ = what < 0.2;
    room_ = what > 0.3 && what < 0.4 ? RoomAhead::too_little_when_uncertain : RoomAhead::enough;
    if (what > 0.4) stop_ = StopReason::pose_uncertain;
    if (what > 0.6) stop_on_backtrack_ = StopReason::pose_uncertain;
    if (what > 0.8) stop_ = stop_on_backtrack_ = StopReason::camera_silent;
  }

  PlanAnswer some_answer() {
    const double what = random_.uniform();
    const Asking* const asking = std::get_if<Asking>(&about_.state);
    if (asking == nullptr)
      return what < 0.5 ? PlanAnswer(PathStaysValid{}) : PlanAnswer(PathMustBeReplaced{});
    if (what < 0.1) return PathStaysValid{};
    if (what < 0.2 && asking->request.kind != PlanKind::new_goal) return PathNotFound{};
    const Vec2 to_m = asking->request.kind == PlanKind::way_back ? Vec2(0.0, 0.0) : Vec2(4.0, 0.0);
    return PathFound{RotateThenDrive({{Vec2(0.5, 0.0), to_m}}, std::nullopt)};
  }

  Random random_;
  Behaviour behaviour_;
  Behaviour about_ = behaviour_;
  BodyVelocity command_ = velocity_of(behaviour_);
  Stamp now_{std::chrono::seconds(10)};
  std::optional<StopReason> stop_;
  std::optional<StopReason> stop_on_backtrack_;
  bool sees_marker_ = false;
  RoomAhead room_ = RoomAhead::enough;
  double change_mps_ = 0.0;
  double change_radps_ = 0.0;
};

TEST(Behaviour, in_any_order_of_events_speeds_up_only_where_it_may_and_never_abruptly) {
  const double most_mps = options.drive.max_acceleration_mps2 * seconds(step_time) + 1e-12;
  const double most_radps = options.drive.max_turn_acceleration_radps2 * seconds(step_time) + 1e-12;
  int backtracks = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (const NamedBehaviour& from : all_behaviours()) {
      SCOPED_TRACE(from.name + ", seed " + std::to_string(seed));
      Story story(from.behaviour, seed);
      for (int i = 0; i < 300; ++i) {
        const double forward_mps = story.command().forward_mps;
        story.step(Wish::go_on);
        ASSERT_LE(story.change_mps(), most_mps);
        ASSERT_LE(story.change_radps(), most_radps);
        const bool backtracks_now = is<Backtracking>(story.about());
        if (backtracks_now) ++backtracks;
        const bool may = backtracks_now ? story.may_go_back() : story.may_move();
        const double speed_mps = std::abs(story.command().forward_mps);
        ASSERT_TRUE(may || speed_mps <= std::abs(forward_mps));
        ASSERT_TRUE(!is<Asking>(story.about()) || speed_mps == 0.0);
      }
    }
  }
  EXPECT_GT(backtracks, 100) << "too few to test anything";
}

TEST(Behaviour, once_cancelled_never_drives_again_whatever_comes) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (const NamedBehaviour& from : all_behaviours()) {
      SCOPED_TRACE(from.name + ", seed " + std::to_string(seed));
      Story story(from.behaviour, seed);
      for (int i = 0; i < 150; ++i) story.step(Wish::cancel);
      EXPECT_FALSE(is_under_way(story.behaviour().state));
      for (int i = 0; i < 300; ++i) {
        story.step(Wish::go_on);
        ASSERT_EQ(story.command().forward_mps, 0.0);
        ASSERT_FALSE(plan_wanted(story.about().state));
      }
    }
  }
}

TEST(Behaviour, while_paused_stands_and_goes_on_with_what_it_was_about) {
  for (const NamedBehaviour& from : all_behaviours()) {
    if (!is_under_way(from.behaviour.state)) continue;
    SCOPED_TRACE(from.name);
    Facts facts = calm();
    facts.wish = Wish::pause;
    Moved last{{}, from.behaviour};
    for (int i = 0; i < 150; ++i) last = step(last.behaviour, facts);
    EXPECT_EQ(last.command.forward_mps, 0.0);
    EXPECT_EQ(last.command.turn_radps, 0.0);
    EXPECT_TRUE(is<Paused>(last.behaviour));
    facts.wish = Wish::go_on;
    const Behaviour resumed = decided(last.behaviour, facts, options);
    EXPECT_TRUE(is_under_way(resumed.state));
    const bool was_going_back = is<Backtracking>(from.behaviour) || from.name == "Paused, backtracking";
    EXPECT_EQ(is<Backtracking>(resumed), was_going_back);
  }
}

TEST(Behaviour, sent_to_another_goal_comes_to_rest_first_and_then_asks_for_a_plan_to_it) {
  for (const NamedBehaviour& from : all_behaviours()) {
    SCOPED_TRACE(from.name);
    Moved last{velocity_of(from.behaviour), sent_to(from.behaviour, {2.0, 1.0}, 0.5, options)};
    Facts facts = calm();
    for (int i = 0; i < 100 && !is<Asking>(last.behaviour); ++i) {
      last.behaviour = decided(last.behaviour, facts, options);
      if (is<Asking>(last.behaviour)) break;
      last = moved(last.behaviour, facts, options);
      facts.now += step_time;
    }
    EXPECT_EQ(last.command.forward_mps, 0.0);
    const std::optional<PlanRequest> wanted = plan_wanted(last.behaviour.state);
    ASSERT_TRUE(wanted);
    EXPECT_EQ(wanted->kind, PlanKind::new_goal);
    EXPECT_EQ(wanted->goal_m, Vec2(2.0, 1.0));
    EXPECT_EQ(wanted->goal_heading_rad, 0.5);
    const Behaviour follows = answered(last.behaviour, PathFound{drive_at_rest()});
    EXPECT_TRUE(is<Following>(follows));
  }
}

TEST(Behaviour, waits_for_its_plan_as_long_as_it_takes) {
  const Trip trip{drive_at_rest(), PlanRequest{.kind = PlanKind::another_way}, true};
  Behaviour behaviour{Asking{trip, *trip.wanted}, places_behind()};
  for (int i = 0; i < 500; ++i) {
    const Moved after = step(behaviour, calm());
    EXPECT_EQ(after.command.forward_mps, 0.0);
    behaviour = after.behaviour;
  }
  EXPECT_TRUE(is<Following>(answered(behaviour, PathFound{drive_at_rest()})));
}

TEST(Behaviour, an_answer_that_comes_too_late_changes_nothing) {
  for (const NamedBehaviour& from : all_behaviours()) {
    if (plan_wanted(from.behaviour.state)) continue;
    SCOPED_TRACE(from.name);
    const Behaviour after = answered(from.behaviour, PathFound{drive_at_rest()});
    EXPECT_EQ(to_string(after.state), to_string(from.behaviour.state));
    EXPECT_EQ(after.state.index(), from.behaviour.state.index());
  }
}

TEST(Behaviour, a_backtrack_that_was_asked_for_in_vain_is_not_asked_for_again) {
  const Trip trip{drive_at_rest(), std::nullopt, true};
  Behaviour behaviour{Asking{trip, {.kind = PlanKind::way_back}}, places_behind()};
  behaviour = answered(behaviour, PathNotFound{});
  EXPECT_FALSE(behaviour.places.possible());
  Facts uncertain = calm();
  uncertain.stop = StopReason::pose_uncertain;
  EXPECT_TRUE(is<Searching>(decided(behaviour, uncertain, options)));
  EXPECT_EQ(to_string(decided(behaviour, calm(), options).state), "Asking: another way");
}

TEST(Behaviour, that_came_back_and_saw_no_marker_stays_and_says_why) {
  const Trip trip{drive_at_rest(), PlanRequest{.kind = PlanKind::another_way}, true};
  const RotateThenDrive way({{Vec2::Zero(), Vec2::Zero()}}, std::nullopt);
  Behaviour behaviour{Backtracking{trip, way}, places_when_backtracking()};
  Facts back = calm();
  back.estimate->map_from_base.position_m = Vec2::Zero();
  behaviour = step(behaviour, back).behaviour;
  const Behaviour about = decided(behaviour, back, options);
  EXPECT_TRUE(is<Searching>(about));
  EXPECT_EQ(shown(about, about, back).stop, StopReason::pose_stale);
}

TEST(Behaviour, tells_people_what_holds_it_up) {
  const Facts facts = calm();
  const Trip trip{drive_at_rest(), std::nullopt, false};
  const auto told = [&](const BehaviourState& state) {
    const Behaviour behaviour{state, places_behind()};
    return shown(behaviour, behaviour, facts);
  };
  EXPECT_EQ(told(Following{trip}).stop, std::nullopt);
  EXPECT_EQ(told(Blocked{trip, false}).stop, StopReason::way_blocked);
  EXPECT_EQ(told(Blocked{trip, true}).stop, StopReason::pose_uncertain);
  EXPECT_EQ(told(Braking{trip, Reason::uncertain}).stop, StopReason::pose_uncertain);
  EXPECT_EQ(told(Backtracking{trip, drive_at_rest()}).stop, std::nullopt);
  EXPECT_TRUE(told(Backtracking{trip, drive_at_rest()}).backtracks);
  Facts stopped = facts;
  stopped.stop = StopReason::camera_silent;
  const Behaviour blocked{Blocked{trip, false}, places_behind()};
  EXPECT_EQ(shown(blocked, blocked, stopped).stop, StopReason::camera_silent);
}

}  // namespace
}  // namespace lodestar
