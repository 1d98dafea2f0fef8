#include "app/common/child_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/common/machine.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

/// Its output goes into a folder that is removed at the end.
ProgramEnd run(const std::string& program, const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  return run_program_to_end(program, arguments, folder / "out", folder / "err");
}

TEST(ChildProgram, gives_exit_code_output_and_last_words) {
  const ProgramEnd end = run("/bin/sh", {"-c", "echo 'a b'; echo one >&2; echo two >&2; exit 3"});
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_EQ(end.output, "a b\n");
  EXPECT_EQ(end.last_words, "two");
}

TEST(ChildProgram, says_which_signal_ended_it) {
  const ProgramEnd end = run("/bin/sh", {"-c", "kill -9 $$"});
  EXPECT_FALSE(end.exit_code);
  EXPECT_EQ(end.why, "signal 9 ended it");
}

TEST(ChildProgram, says_that_it_did_not_begin) {
  const ProgramEnd end = run("/no/such/program", {});
  EXPECT_FALSE(end.exit_code);
  EXPECT_THAT(end.why, HasSubstr("did not begin"));
}

TEST(MachineFacts, are_read_from_what_the_kernel_says) {
  const Machine machine =
      machine_from("processor\t: 0\nmodel name\t: Abacus 9\nmodel name\t: Abacus 9\n",
                   "MemTotal:       16777216 kB\nMemFree: 1 kB\n",
                   "NAME=\"Debian\"\nPRETTY_NAME=\"Debian 12\"\n", "1.25 1.00 0.5 1/2 3\n");
  EXPECT_EQ(machine.processor, "Abacus 9");
  EXPECT_DOUBLE_EQ(machine.memory_gb, 16.0);
  EXPECT_EQ(machine.system, "Debian 12");
  EXPECT_DOUBLE_EQ(machine.load, 1.25);
}

TEST(MachineFacts, that_are_missing_are_unknown) {
  const Machine machine = machine_from("", "", "", "");
  EXPECT_EQ(machine.processor, "unknown");
  EXPECT_EQ(machine.system, "unknown");
}

}  // namespace
}  // namespace lodestar
