#include "app/fleet/action_hooks.hpp"

#include <array>
#include <chrono>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>

namespace lodestar {
namespace {

ActionHook hook(const std::string& type, const std::string& script, double timeout_s = 60.0) {
  return {.type = type, .command = {"/bin/sh", "-c", script}, .timeout = from_seconds(timeout_s)};
}

FleetAction action(const std::string& type, std::map<std::string, std::string> parameters = {}) {
  return {.id = "id-" + type, .type = type, .blocking = Blocking::hard, .parameters = std::move(parameters)};
}

HookResult result_of(ActionHooks& hooks) {
  for (;;) {
    const std::vector<HookResult> results = hooks.take_ended();
    if (!results.empty()) return results.front();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(ActionHooks, exit_code_0_is_success_with_the_first_line_as_the_result) {
  ActionHooks hooks({hook("pick", "echo 'box 7'; echo more")}, "/");
  EXPECT_TRUE(hooks.carries_out("pick"));
  EXPECT_FALSE(hooks.carries_out("drop"));
  hooks.start(action("pick"));
  const HookResult result = result_of(hooks);
  EXPECT_EQ(result.action_id, "id-pick");
  EXPECT_TRUE(result.succeeded);
  EXPECT_EQ(result.words, "box 7");
}

TEST(ActionHooks, the_program_reads_the_action_and_runs_in_the_sites_folder) {
  ActionHooks hooks({hook("pick", "read line; echo \"$line $PWD\"")}, "/usr");
  hooks.start(action("pick", {{"side", "left"}}));
  EXPECT_EQ(result_of(hooks).words,
            R"({"actionId":"id-pick","actionType":"pick","parameters":{"side":"left"}} /usr)");
}

TEST(ActionHooks, any_other_end_is_a_failure_with_its_reason) {
  ActionHooks hooks({hook("code", "echo jammed; exit 3"),
                     hook("signal", "kill -9 $$"),
                     hook("slow", "exec sleep 600", 0.2),
                     {.type = "none", .command = {"/nowhere"}}},
                    "/");
  for (const auto& [type, words] : std::map<std::string, std::string>{{"code", "exit code 3: jammed"},
                                                                      {"signal", "ended by signal 9"},
                                                                      {"slow", "not done after 0.2 s"},
                                                                      {"none", "/nowhere cannot be run"}}) {
    hooks.start(action(type));
    const HookResult result = result_of(hooks);
    EXPECT_FALSE(result.succeeded) << type;
    EXPECT_EQ(result.words, words);
  }
}

/// A child of the program would keep this pipe open.
TEST(ActionHooks, what_nobody_wants_any_more_is_ended_with_its_children) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  {
    ActionHooks hooks({hook("long", "sleep 600 & sleep 600")}, "/");
    hooks.start(action("long"));
    hooks.keep([](const std::string& id) { return id != "id-long"; });
  }  // waits for its end
  close(ends[1]);
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 0);
  close(ends[0]);
}

TEST(ActionHooks, no_more_than_eight_run_at_once) {
  ActionHooks hooks({hook("long", "sleep 600")}, "/");
  for (int i = 0; i < 9; ++i) {
    FleetAction one = action("long");
    one.id += std::to_string(i);
    hooks.start(one);
  }
  EXPECT_EQ(result_of(hooks).words, "too many programs at once");
}

}  // namespace
}  // namespace lodestar
