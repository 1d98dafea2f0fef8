#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenarios/command_line.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const fs::path data = fs::path(LODESTAR_SOURCE_DIR) / "tests/data";

Ran bench(const fs::path& scenario, const fs::path& folder) {
  return run_lodestar("bench plan --map " + (data / "rooms.map").string() + " --scen " + scenario.string(),
                      folder);
}

TEST(BenchPlan, finds_every_query_of_a_scenario_optimal) {
  const ScratchFolder scratch;
  const Ran ran = bench(data / "rooms.map.scen", scratch.path());
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_THAT(ran.out, StartsWith("index,expected,found,microseconds,expanded\n0,1.00000000,1.00000000,"));
  EXPECT_THAT(ran.err, HasSubstr("30 of 30 queries optimal"));
}

TEST(BenchPlan, fails_when_the_scenario_expects_another_length) {
  const ScratchFolder scratch;
  std::string text = read_text(data / "rooms.map.scen");
  text.replace(text.find("1.00000000"), 10, "0.90000000");
  write_text(scratch.path() / "wrong.scen", text);
  const Ran ran = bench(scratch.path() / "wrong.scen", scratch.path());
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("29 of 30 queries optimal"));
}

TEST(BenchPlan, names_file_and_line_of_a_broken_scenario) {
  const ScratchFolder scratch;
  write_text(scratch.path() / "broken.scen", "version 1\nnonsense\n");
  const Ran ran = bench(scratch.path() / "broken.scen", scratch.path());
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("broken.scen:2: found"));
  EXPECT_EQ(ran.out, "");
}

}  // namespace
}  // namespace lodestar
