#include "app/placement/exploration.hpp"

#include <filesystem>
#include <gmock/gmock.h>

namespace lodestar {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ExplorationShortcomings : public testing::Test {
 protected:
  Site site = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  Exploration exploration{site, site.default_camera, {.map_from_base = site.start}};

  /// Two markers, and how well they are tied to each other.
  static SurveyProgress progress_with(double link_sigma_m) {
    SurveyProgress progress{.target_sigma_m = 0.002};
    progress.survey.markers = {{.id = 7}, {.id = 12}};
    progress.links = {{.first = 7, .second = 12, .sigma_m = link_sigma_m}};
    return progress;
  }
};

TEST_F(ExplorationShortcomings, are_none_when_every_marker_meets_the_target) {
  const SurveyProgress progress = progress_with(0.0019);
  EXPECT_THAT(exploration.shortcomings(&progress), IsEmpty());
}

TEST_F(ExplorationShortcomings, name_the_markers_above_the_target) {
  const SurveyProgress progress = progress_with(0.0031);
  EXPECT_THAT(exploration.shortcomings(&progress), ElementsAre(HasSubstr("2.0 mm: markers 7, 12")));
}

TEST_F(ExplorationShortcomings, are_a_survey_that_contradicts_itself_or_has_no_marker) {
  SurveyProgress progress = progress_with(0.0019);
  SurveyRefusal& refusal = progress.survey.flaws.emplace_back();
  refusal.flaw = SurveyFlaw::contradiction;
  refusal.found = "marker 7 as if it had moved";
  EXPECT_THAT(exploration.shortcomings(&progress), ElementsAre(HasSubstr("contradiction: marker 7")));
  EXPECT_THAT(exploration.shortcomings(nullptr), ElementsAre(HasSubstr("no marker")));
}

/// A lane's end need not have a marker in view.
TEST(Explorer, counts_a_goal_as_reached_that_it_failed_to_see_but_came_near_to) {
  const Site site = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  Explorer explorer(site, site.default_camera, {.map_from_base = site.start});
  const std::size_t lanes = explorer.lanes_left();
  const auto goal = explorer.next(site.start.position_m, nullptr);
  ASSERT_TRUE(goal);
  explorer.failed(Vec2(goal->position_m + Vec2(0.3, 0.0)));
  const auto end = explorer.next(goal->position_m, nullptr);
  ASSERT_TRUE(end);
  EXPECT_NE(end->position_m, goal->position_m) << "goes on along the lane";
  explorer.failed(Vec2(end->position_m + Vec2(0.3, 0.0)));
  EXPECT_EQ(explorer.lanes_left(), lanes - 1);
  const auto next = explorer.next(end->position_m, nullptr);
  ASSERT_TRUE(next);
  explorer.failed(Vec2(next->position_m + Vec2(0.0, 3.0)));
  EXPECT_EQ(explorer.lanes_left(), lanes - 1) << "that one is tried once more";
  EXPECT_EQ(explorer.lanes_given_up(), 0U);
}

}  // namespace
}  // namespace lodestar
