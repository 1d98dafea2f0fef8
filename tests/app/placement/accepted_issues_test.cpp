#include "app/placement/accepted_issues.hpp"

#include <fstream>
#include <gmock/gmock.h>

#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;
using ::testing::IsNull;
using ::testing::NotNull;

RegistryIssue gap(const Vec2& low_m, const Vec2& high_m) {
  return {.kind = IssueKind::gap, .words = "a gap", .places_m = {low_m, high_m}};
}

const AcceptedIssue storeroom{.kind = IssueKind::gap,
                              .places_m = {{1.0, 2.0}, {3.0, 4.0}},
                              .reason = "a storeroom",
                              .at = "2026-11-26"};

TEST(AcceptedIssues, are_read_as_they_were_written) {
  const TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  EXPECT_TRUE(load_accepted(folder).empty());
  const AcceptedIssue alike{.kind = IssueKind::similar_ids,
                            .ids = {77, 620},
                            .reason = "\"far\": apart\n# no comment",
                            .by = "Ann",
                            .at = "2026-11-26T09:00:00Z"};
  save_accepted(std::vector{storeroom, alike}, folder);
  const std::vector<AcceptedIssue> read = load_accepted(folder);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].kind, IssueKind::gap);
  EXPECT_EQ(read[0].places_m, storeroom.places_m);
  EXPECT_EQ(read[0].by, "");
  EXPECT_EQ(read[1].kind, IssueKind::similar_ids);
  EXPECT_EQ(read[1].ids, alike.ids);
  EXPECT_EQ(read[1].reason, alike.reason);
  EXPECT_EQ(read[1].by, "Ann");
  EXPECT_EQ(read[1].at, alike.at);
}

TEST(AcceptedIssues, let_a_gap_stand_until_it_grows) {
  const std::vector accepted{storeroom};
  EXPECT_THAT(acceptance_of(gap({1.0, 2.0}, {3.0, 4.0}), accepted), NotNull());
  EXPECT_THAT(acceptance_of(gap({1.3, 2.3}, {2.7, 3.7}), accepted), NotNull());
  EXPECT_THAT(acceptance_of(gap({1.0, 2.0}, {3.0, 4.6}), accepted), IsNull());
  EXPECT_THAT(acceptance_of(gap({5.0, 2.0}, {7.0, 4.0}), accepted), IsNull());
}

TEST(AcceptedIssues, let_a_stretch_stand_from_either_end) {
  const std::vector<AcceptedIssue> accepted{
      {.kind = IssueKind::blind_route, .places_m = {{0.0, 0.0}, {5.0, 0.0}}, .reason = "a tunnel"}};
  RegistryIssue stretch{.kind = IssueKind::blind_route, .places_m = {{5.0, 0.1}, {0.1, 0.0}}};
  EXPECT_THAT(acceptance_of(stretch, accepted), NotNull());
  stretch.kind = IssueKind::gap;
  EXPECT_THAT(acceptance_of(stretch, accepted), IsNull()) << "another kind";
}

TEST(AcceptedIssues, let_the_same_markers_stand_wherever_they_are_and_no_others) {
  const std::vector<AcceptedIssue> accepted{
      {.kind = IssueKind::similar_ids, .ids = {620, 77}, .reason = "far apart"}};
  RegistryIssue issue{.kind = IssueKind::similar_ids, .ids = {77, 620}, .places_m = {{9.0, 9.0}}};
  EXPECT_THAT(acceptance_of(issue, accepted), NotNull());
  EXPECT_TRUE(issue_json(issue, accepted).contains("accepted"));
  issue.ids = {77, 621};
  EXPECT_THAT(acceptance_of(issue, accepted), IsNull());
  EXPECT_FALSE(issue_json(issue, accepted).contains("accepted"));
}

TEST(AcceptedIssues, let_no_error_stand) {
  RegistryIssue repeated{.kind = IssueKind::repeated_id, .error = true, .ids = {77}};
  const std::vector<AcceptedIssue> accepted{
      {.kind = IssueKind::repeated_id, .ids = {77}, .reason = "why not"}};
  EXPECT_THAT(acceptance_of(repeated, accepted), IsNull());
}

TEST(AcceptedIssues, are_refused_by_line_where_they_are_unusable) {
  const TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  const auto refused = [&](const std::string& item) -> std::string {
    std::ofstream(folder / accepted_file_name) << "format: lodestar-accepted\nversion: 1\naccepted:\n"
                                               << item;
    try {
      (void)load_accepted(folder);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused("  - {kind: gap, reason: r, at: t, places_m: [[1, 2], [3, 4]]}\n"), "");
  EXPECT_THAT(refused("  - {kind: hole, reason: r, at: t, ids: [1]}\n"),
              HasSubstr("accepted.yaml:4: found 'hole'"));
  EXPECT_THAT(refused("  - {kind: gap, reason: r, at: t}\n"), HasSubstr("neither ids nor places_m"));
  EXPECT_THAT(refused("  - {kind: similar-ids, reason: r, at: t, ids: [1.5]}\n"), HasSubstr("found 1.5"));
  EXPECT_THAT(refused("  - {kind: similar-ids, reason: r, at: t, ids: 7}\n"), HasSubstr("accepted.yaml:4"));
  EXPECT_THAT(refused("  - {kind: gap, at: t, ids: [1]}\n"), HasSubstr("reason"));
}

}  // namespace
}  // namespace lodestar
