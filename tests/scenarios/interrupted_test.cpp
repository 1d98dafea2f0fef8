#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "tests/scenarios/command_line.hpp"

// What long commands leave when they are told to end, and where they may write.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A line of the shell, in a folder of its own; LODESTAR stands for the program.
class Shell : public ::testing::Test {
 protected:
  Ran run(std::string line) const {
    const std::string program = "LODESTAR";
    for (std::size_t at = 0; (at = line.find(program, at)) != std::string::npos;)
      line.replace(at, program.size(), "'" LODESTAR_BINARY "'");
    const std::string folder = scratch_.path().string();
    const std::string whole = "cd '" + folder + "' && (" + line + ") >out.txt 2>err.txt </dev/null";
    const int status = std::system(whole.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(scratch_.path() / "out.txt"),
            read_text(scratch_.path() / "err.txt")};
  }

  /// Starts a command, waits until `file` has content, and tells it to end as a service manager does.
  Ran interrupted(const std::string& arguments, const std::string& file) const {
    return run("LODESTAR " + arguments + " & job=$!; for i in $(seq 1200); do [ -s " + file +
               " ] && break; sleep 0.1; done; kill -TERM $job; wait $job");
  }

  ScratchFolder scratch_;
};

TEST_F(Shell, interrupts_a_campaign_which_reports_what_it_has_and_can_be_resumed) {
  const Ran ran = interrupted("campaign 100000 --quiet -o found", "found/missions.jsonl");
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr(" missions: "));
  EXPECT_THAT(ran.err, HasSubstr("interrupted"));
  EXPECT_THAT(ran.err, HasSubstr("--resume"));
  EXPECT_TRUE(fs::exists(scratch_.path() / "found/campaign.json"));

  const std::string before = read_text(scratch_.path() / "found/missions.jsonl");
  const Ran again = run("LODESTAR campaign 1 --quiet -o found");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("found/missions.jsonl: found"));
  EXPECT_EQ(read_text(scratch_.path() / "found/missions.jsonl"), before) << "results were lost";
}

TEST_F(Shell, interrupts_a_replay_which_leaves_its_whole_run_folder) {
  const Ran ran = interrupted("replay --realtime --quiet --json -o run", "run/can.log");
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("interrupted"));
  const auto summary = nlohmann::json::parse(ran.out, nullptr, false);
  ASSERT_TRUE(summary.is_object()) << ran.out;
  EXPECT_TRUE(summary["worst_position_m"].is_null()) << "no goal was reached";
  EXPECT_TRUE(summary["worst_heading_deg"].is_null());
  for (const char* name : {"summary.json", "report.html", "estimate.tum"})
    EXPECT_TRUE(fs::exists(scratch_.path() / "run" / name)) << name;
}

TEST_F(Shell, interrupts_many_replays_of_which_those_finished_are_printed) {
  const Ran ran =
      run("LODESTAR replay --runs 100000 --goal 2.2,5.61 --quiet --json & job=$!; sleep 1; "
          "kill -TERM $job; wait $job");
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("interrupted after "));
  EXPECT_TRUE(nlohmann::json::parse(ran.out, nullptr, false).is_array()) << ran.out;
}

TEST_F(Shell, interrupts_a_soak_which_has_not_passed_then) {
  const Ran ran = interrupted("soak --minutes 1000 -o soaked", "soaked/soak.json");
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("interrupted"));
  EXPECT_THAT(ran.out, HasSubstr("\"missions\""));
}

TEST_F(Shell, sets_a_limit_to_files_beyond_which_writing_is_an_error_not_the_end) {
  const Ran ran = run("ulimit -f 8; LODESTAR replay --goal 2.2,5.61 --quiet -o run");
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("the run is not recorded as a whole"));
}

TEST_F(Shell, names_a_folder_that_cannot_be_made) {
  for (const char* command : {"soak --minutes 0.01 -o /proc/none/soak", "campaign 1 -o /proc/none/campaign",
                              "replay --runs 2 --goal 2.2,5.61 --quiet -o /proc/none/runs"}) {
    const Ran ran = run(std::string("LODESTAR ") + command);
    EXPECT_EQ(ran.exit_code, 2) << command << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("/proc/none/")) << command;
  }
}

}  // namespace
}  // namespace lodestar
