#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <set>
#include <sstream>

#include "tests/control/behaviours.hpp"

namespace lodestar {
namespace {

std::string_view words(PlanKind kind) {
  constexpr std::array names{"extension", "review", "replan", "another way", "new goal", "way back"};
  return names.at(static_cast<std::size_t>(kind));
}

/// The state's name, the kind of plan that it will request at rest, and the review that it requests of the
/// path that it keeps following.
std::string words(const BehaviourState& state) {
  std::string text(to_string(state));
  const auto* braking = std::get_if<Braking>(&state);
  if (braking != nullptr && braking->reason == Braking::Reason::replan && braking->trip.wanted)
    text += fmt::format(" ({})", words(braking->trip.wanted->kind));
  const std::optional<PlanRequest> wanted = plan_wanted(state);
  if (wanted && wanted->kind == PlanKind::review) text += ", wants review";
  return text;
}

std::string row(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

std::string next_or_same(const Behaviour& before, const Behaviour& after) {
  const std::string next = words(after.state);
  return next == words(before.state) ? "-" : next;
}

/// A column of a table: an event, and the behaviour that results.
struct Column {
  std::string name;
  std::function<Behaviour(const Behaviour&)> happens;
};

std::string table(const std::vector<NamedBehaviour>& behaviours, const std::vector<Column>& columns) {
  std::vector<std::string> head{"from"};
  for (const Column& column : columns) head.push_back(column.name);
  std::string text = row(head) + row(std::vector<std::string>(head.size(), "---"));
  for (const NamedBehaviour& from : behaviours) {
    std::vector<std::string> cells{from.name};
    for (const Column& column : columns)
      cells.push_back(next_or_same(from.behaviour, column.happens(from.behaviour)));
    text += row(cells);
  }
  return text;
}

/// A paused robot stays paused unless the column has another wish.
std::vector<Column> deciding(const std::vector<NamedFacts>& happenings) {
  std::vector<Column> columns;
  for (const NamedFacts& happening : happenings)
    columns.push_back({happening.name, [happening](const Behaviour& before) {
                         Facts facts = happening.facts;
                         const bool is_paused = std::holds_alternative<Paused>(before.state);
                         if (is_paused && facts.wish == Wish::go_on && happening.name != "go on")
                           facts.wish = Wish::pause;
                         return decided(before, facts, {});
                       }});
  return columns;
}

std::vector<NamedBehaviour> only(const std::vector<std::string>& names) {
  std::vector<NamedBehaviour> some;
  for (const NamedBehaviour& behaviour : all_behaviours())
    if (std::ranges::find(names, behaviour.name) != names.end()) some.push_back(behaviour);
  return some;
}

Column answering(const std::string& name, const PlanAnswer& answer) {
  return {name, [answer](const Behaviour& before) { return answered(before, answer); }};
}

/// Columns that drive for a number of steps.
std::vector<Column> motions() {
  const auto moving = [](const std::function<void(Facts&)>& change, int steps) {
    return [change, steps](const Behaviour& before) {
      Facts facts = calm();
      change(facts);
      Behaviour behaviour = before;
      for (int i = 0; i < steps; ++i) behaviour = moved(behaviour, facts, {}).behaviour;
      return behaviour;
    };
  };
  const auto at_goal = [](Facts& facts) { facts.estimate->map_from_base.position_m = {4.0, 0.0}; };
  const auto at_place = [](Facts& facts) { facts.estimate->map_from_base = {Vec2::Zero(), radians(180.0)}; };
  const auto doubtful = [](Facts& facts) { facts.room_ahead = RoomAhead::too_little_when_uncertain; };
  const auto no_room = [](Facts& facts) {
    facts.room_ahead = RoomAhead::none;
    facts.limit.forward_mps = 0.0;
  };
  const auto no_room_back = [](Facts& facts) {
    facts.estimate->map_from_base.yaw_rad = radians(180.0);
    facts.limit_on_backtrack.forward_mps = 0.0;
  };
  const auto uncertain = [](Facts& facts) { facts.stop_on_backtrack = StopReason::pose_uncertain; };
  constexpr int to_rest = 200;
  return {{"at rest", moving([](Facts&) {}, to_rest)},
          {"at its goal", moving(at_goal, to_rest)},
          {"too little clearance for its uncertainty", moving(doubtful, 1)},
          {"no room ahead", moving(no_room, 1)},
          {"back where it saw a marker", moving(at_place, to_rest)},
          {"no room on the way back", moving(no_room_back, to_rest)},
          {"too uncertain even to backtrack", moving(uncertain, to_rest)}};
}

std::vector<Column> operator_columns() {
  std::vector<Column> columns = deciding(all_wishes());
  columns.push_back(
      {"new goal", [](const Behaviour& before) { return sent_to(before, {2.0, 1.0}, std::nullopt, {}); }});
  return columns;
}

std::string documentation() {
  std::ostringstream text;
  text << std::ifstream(std::filesystem::path(LODESTAR_SOURCE_DIR) / "docs/behaviours.md").rdbuf();
  return text.str();
}

void expect_in_documentation(const std::string& wanted) {
  EXPECT_NE(documentation().find(wanted), std::string::npos)
      << "docs/behaviours.md lacks this table of what the code does:\n"
      << wanted;
}

TEST(BehaviourTable, of_what_a_step_finds_is_that_of_the_documentation) {
  expect_in_documentation(table(all_behaviours(), deciding(all_findings())));
}

TEST(BehaviourTable, of_what_the_operator_wishes_is_that_of_the_documentation) {
  expect_in_documentation(table(all_behaviours(), operator_columns()));
}

TEST(BehaviourTable, of_what_comes_of_a_review_is_that_of_the_documentation) {
  const PlanRequest review{.kind = PlanKind::review};
  const Trip rolling{rolling_drive(), review, false};
  const Trip standing{drive_at_rest(), review, false};
  expect_in_documentation(
      table({{"Following", {Following{rolling}, places_behind()}},
             {"Blocked", {Blocked{standing, false}, places_behind()}}},
            {answering("the path holds", PathStaysValid{}), answering("it is to go", PathMustBeReplaced{})}));
}

TEST(BehaviourTable, of_what_comes_of_a_plan_is_that_of_the_documentation) {
  expect_in_documentation(
      table(only({"Asking: replan", "Asking: another way", "Asking: new goal", "Asking: way back"}),
            {answering("found", PathFound{drive_at_rest()}), answering("the old one holds", PathStaysValid{}),
             answering("none is found", PathNotFound{})}));
}

TEST(BehaviourTable, of_what_comes_of_moving_is_that_of_the_documentation) {
  expect_in_documentation(table(only({"Following", "Blocked", "Braking: end", "Backtracking"}), motions()));
}

TEST(BehaviourTable, lists_every_state_and_every_reason_to_brake) {
  std::set<std::string_view> listed;
  std::set<std::size_t> states;
  for (const NamedBehaviour& behaviour : all_behaviours()) {
    listed.insert(to_string(behaviour.behaviour.state));
    states.insert(behaviour.behaviour.state.index());
  }
  EXPECT_EQ(states.size(), std::variant_size_v<BehaviourState>);
  EXPECT_EQ(std::ranges::count_if(listed, [](auto name) { return name.starts_with("Braking"); }), 5);
  EXPECT_EQ(std::ranges::count_if(listed, [](auto name) { return name.starts_with("Asking"); }), 4);
}

}  // namespace
}  // namespace lodestar
