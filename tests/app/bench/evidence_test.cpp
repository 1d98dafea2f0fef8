#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdexcept>

#include "app/bench/evidence_page.hpp"
#include "app/bench/evidence_parts.hpp"
#include "app/bench/evidence_readers.hpp"

// A bench's output becomes rows; whatever goes wrong instead has a row that says so.
namespace lodestar {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::Not;

EvidencePart part_that_reads(std::vector<EvidenceRow> rows) {
  return {.name = "drops",
          .title = "Falling drops",
          .arguments = {"bench", "drops"},
          .quick_arguments = {"bench", "drops", "--quick"},
          .promises = {"drops caught", "drops lost"},
          .read = [rows](const std::string&) { return rows; },
          .conclude = "this",
          .not_conclude = "that"};
}

RunPart ending_with(ProgramEnd end) {
  return [end](const EvidencePart&, const std::vector<std::string>&) { return end; };
}

const auto standing = [](const auto& matcher) { return Field(&EvidenceRow::standing, matcher); };
const auto why = [](const auto& matcher) { return Field(&EvidenceRow::why, matcher); };

TEST(Evidence, judges_a_figure_by_its_limit) {
  EXPECT_EQ(at_most("x", 1.0, 1.0, "ms").standing, EvidenceStanding::kept);
  EXPECT_EQ(at_most("x", 1.1, 1.0, "ms").standing, EvidenceStanding::missed);
  EXPECT_EQ(at_least("x", 0.9, 1.0, "%").standing, EvidenceStanding::missed);
  EXPECT_EQ(at_least("x", 0.9, 1.0, "%").limit, "at least 1 %");
  EXPECT_EQ(at_most("x", 1.25, 2.0, "ms").today, "1.25 ms");
}

TEST(Evidence, has_the_rows_that_the_output_gives) {
  const auto section =
      gather(part_that_reads({at_most("drops lost", 0, 0, "")}), false, ending_with({.exit_code = 0}));
  EXPECT_THAT(section.rows, ElementsAre(standing(EvidenceStanding::kept)));
  EXPECT_EQ(section.command, "lodestar bench drops");
}

TEST(Evidence, judges_by_a_quick_run_only_what_one_case_breaks) {
  const auto part = part_that_reads(
      {at_most("drops lost", 0, 0, ""), at_most("wind", 3, 2, "m/s"), at_most("splashes", 3, 0, "")});
  const auto section = gather(part, true, ending_with({.exit_code = 0}));
  EXPECT_THAT(section.rows,
              ElementsAre(standing(EvidenceStanding::not_judged), standing(EvidenceStanding::not_judged),
                          standing(EvidenceStanding::missed)));
  EXPECT_EQ(section.command, "lodestar bench drops --quick");
}

TEST(Evidence, shows_each_promise_of_a_command_that_failed_with_its_last_words) {
  const auto section = gather(part_that_reads({at_most("drops lost", 0, 0, "")}), false,
                              ending_with({.exit_code = 2, .last_words = "lodestar: no bucket"}));
  ASSERT_EQ(section.rows.size(), 2U);
  EXPECT_THAT(section.rows, Each(standing(EvidenceStanding::failed)));
  EXPECT_THAT(section.rows, Each(why("exit code 2: lodestar: no bucket")));
}

TEST(Evidence, shows_a_command_that_a_signal_ended) {
  const auto section = gather(part_that_reads({at_most("drops lost", 0, 0, "")}), false,
                              ending_with({.why = "signal 11 ended it"}));
  EXPECT_THAT(section.rows, Each(why("signal 11 ended it")));
  EXPECT_THAT(section.rows, Each(standing(EvidenceStanding::failed)));
}

TEST(Evidence, shows_an_output_that_cannot_be_read) {
  EvidencePart part = part_that_reads({});
  EXPECT_THAT(gather(part, false, ending_with({.exit_code = 0})).rows,
              Each(why("its output has no figures")));
  part.read = localize_rows;
  const auto section = gather(part, false, ending_with({.exit_code = 0, .output = "Killed"}));
  EXPECT_THAT(section.rows, Each(why(HasSubstr("its output could not be read"))));
  EXPECT_THAT(section.rows, Each(standing(EvidenceStanding::failed)));
}

TEST(Evidence, takes_the_commands_own_verdict_when_no_row_shows_why) {
  const auto kept = part_that_reads({at_most("drops lost", 0, 0, "")});
  const auto section = gather(kept, false, ending_with({.exit_code = 1, .last_words = "too wet"}));
  EXPECT_THAT(section.rows,
              ElementsAre(standing(EvidenceStanding::kept), standing(EvidenceStanding::missed)));
  const auto missed = part_that_reads({at_most("drops lost", 1, 0, "")});
  EXPECT_EQ(gather(missed, false, ending_with({.exit_code = 1})).rows.size(), 1U);
}

TEST(Evidence, runs_nothing_where_what_it_needs_is_not_there) {
  EvidencePart part = part_that_reads({});
  part.needs = "no/such/map.yaml";
  const auto section = gather(
      part, false, [](const auto&, const auto&) -> ProgramEnd { throw std::logic_error("it was run"); });
  EXPECT_THAT(section.rows, Each(standing(EvidenceStanding::not_possible)));
  EXPECT_THAT(section.rows, Each(why("no/such/map.yaml is not there")));
}

Evidence evidence_of(std::vector<EvidenceSection> sections) {
  return {
      .version = "1.2.3",
      .date = "2026-01-02 03:04 UTC",
      .machine = {.processor = "Abacus <9>", .cores = 3, .memory_gb = 7.5, .system = "Debian", .load = 2.0},
      .build = {.compiler = "g++ 12", .is_optimized = true, .commit = "abc123"},
      .sections = std::move(sections)};
}

TEST(EvidencePage, holds_each_row_of_each_part_and_what_may_be_concluded) {
  std::vector<EvidenceSection> sections;
  for (const EvidencePart& part : evidence_parts())
    sections.push_back(without_figures(part, false, EvidenceStanding::left_out, "a reason"));
  ASSERT_GE(sections.size(), 10U);
  const std::string page = evidence_html(evidence_of(sections));
  for (const EvidenceSection& section : sections) {
    ASSERT_FALSE(section.rows.empty()) << section.part.name;
    EXPECT_THAT(page, HasSubstr("<code>" + section.command));
    EXPECT_THAT(page, HasSubstr("<h2 id=\"" + section.part.name + "\">"));
    for (const EvidenceRow& row : section.rows) EXPECT_THAT(page, HasSubstr(row.what.substr(0, 12)));
    EXPECT_FALSE(section.part.conclude.empty() || section.part.not_conclude.empty()) << section.part.name;
  }
}

TEST(EvidencePage, shows_a_failed_bench_as_failed_and_does_not_hold) {
  const EvidencePart part = part_that_reads({at_most("drops lost", 0, 0, "")});
  const Evidence good = evidence_of({gather(part, false, ending_with({.exit_code = 0}))});
  EXPECT_TRUE(good.holds());
  EXPECT_THAT(evidence_html(good), Not(HasSubstr("<tr class=\"failed\">")));

  const Evidence bad =
      evidence_of({gather(part, false, ending_with({.exit_code = 139, .last_words = "a <b> c"}))});
  EXPECT_FALSE(bad.holds());
  const std::string page = evidence_html(bad);
  EXPECT_THAT(page, HasSubstr("<tr class=\"failed\"><td>drops caught</td>"));
  EXPECT_THAT(page, HasSubstr("exit code 139: a &lt;b&gt; c"));
  EXPECT_THAT(evidence_text(bad), HasSubstr("failed: drops lost: exit code 139"));
}

TEST(EvidencePage, says_on_which_machine_and_which_build) {
  const std::string page = evidence_html(evidence_of({}));
  for (const char* const said :
       {"1.2.3", "abc123", "2026-01-02", "Abacus &lt;9&gt;; 3 cores", "7.5 GB", "g++ 12"})
    EXPECT_THAT(page, HasSubstr(said));
  EXPECT_THAT(page, HasSubstr("others computed too"));
  EXPECT_THAT(page, Not(HasSubstr("NOT OPTIMIZED")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));  // self-contained
}

}  // namespace
}  // namespace lodestar
