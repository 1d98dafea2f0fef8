#include "localization/survey/survey_difference.hpp"

#include <algorithm>
#include <gmock/gmock.h>

#include "localization/survey/weakest_links.hpp"

#include "tests/app/bench/survey_tour.hpp"

namespace lodestar {
namespace {

using namespace survey_sample;

TEST(SurveyDifference, finds_exactly_what_has_changed) {
  SurveyWorld world = make_survey_world(marker_grid(8.0, 6.0, 2.0, ceiling_m, 5), {}, 17);
  const MarkerRegistry registry{.markers = world.markers};
  RegisteredMarker& moved = world.markers[0];
  moved.position_m += Vec3(0.05, 0.049, 0.0);  // 7 cm
  moved.yaw_rad += radians(5.0);
  std::swap(world.markers[1].id, world.markers[4].id);
  const int gone = world.markers[2].id;
  const RegisteredMarker hung{.id = 3003, .position_m = {2.0, 2.0, ceiling_m}, .yaw_rad = 0.3};
  world.markers[2] = hung;
  const SurveyDrive drive = drive_survey(world, lanes(8.0, 6.0), 18);
  const MarkerSurvey survey = survey_markers(std::span(&drive.log, 1), world.camera, world.belief,
                                             exact_print(), {.most_sigma_m = 1.0});
  ASSERT_TRUE(survey.flaws.empty()) << words_of(survey);
  const auto difference = compare(survey, registry, world.camera);
  ASSERT_TRUE(difference);
  std::vector<std::pair<int, MarkerChange>> changes;
  for (const MarkerProposal& p : difference->proposals) changes.emplace_back(p.id, p.change);
  EXPECT_THAT(changes, testing::UnorderedElementsAre(std::pair(moved.id, MarkerChange::moved),
                                                     std::pair(world.markers[1].id, MarkerChange::swapped),
                                                     std::pair(world.markers[4].id, MarkerChange::swapped),
                                                     std::pair(gone, MarkerChange::gone),
                                                     std::pair(hung.id, MarkerChange::appeared)));
  const auto& proposal = *std::ranges::find(difference->proposals, moved.id, &MarkerProposal::id);
  EXPECT_LT((proposal.offset_m - Vec2(0.05, 0.049)).norm(), 0.0015);
  EXPECT_NEAR(degrees(proposal.turn_rad), 5.0, 0.15);
}

/// The print's scale is known to 0.2 % only: 9 mm at the room's end, which all markers there would share.
TEST(SurveyDifference, finds_a_small_move_at_the_end_of_a_room_without_knowing_the_scale) {
  constexpr double longer = 1.0015;  // print and registry may differ so
  for (const double scale : {1.0, longer}) {
    SurveyWorld world =
        make_survey_world(marker_grid(12.0, 6.0, 2.0, ceiling_m, 5), {.print_scale = scale}, 17);
    const MarkerRegistry registry{.markers = world.markers};
    RegisteredMarker& moved = world.markers[0];
    moved.position_m.x() -= 0.03;
    const SurveyDrive drive = drive_survey(world, lanes(12.0, 6.0), 18);
    const MarkerSurvey survey =
        survey_markers(std::span(&drive.log, 1), world.camera, world.belief, {}, {.most_sigma_m = 1.0});
    ASSERT_TRUE(survey.flaws.empty()) << words_of(survey);
    const auto difference = compare(survey, registry, world.camera);
    ASSERT_TRUE(difference);
    ASSERT_EQ(difference->proposals.size(), 1U) << "scale " << scale;
    const MarkerProposal& proposal = difference->proposals.front();
    EXPECT_EQ(proposal.id, moved.id);
    EXPECT_LT((proposal.offset_m - Vec2(-0.03, 0.0)).norm(), 0.0025);
    EXPECT_LT(proposal.sigma_m, 0.004);
    EXPECT_NEAR(difference->scale, scale, 4e-4) << "the registry's metres are true, the print's are not";
  }
}

TEST(SurveyDifference, says_nothing_of_a_survey_that_has_no_covariance) {
  const SurveyTour tour = small_tour(19);
  MarkerSurvey survey = survey_of(tour);
  survey.covariance = {};
  EXPECT_FALSE(compare(survey, {.markers = tour.world.markers}, tour.world.camera));
}

TEST(SurveyDifference, says_nothing_changed_when_nothing_has) {
  const SurveyTour tour = small_tour(19);
  const MarkerRegistry registry{.markers = tour.world.markers};
  const auto difference = compare(survey_of(tour), registry, tour.world.camera);
  ASSERT_TRUE(difference);
  EXPECT_TRUE(difference->proposals.empty());
  EXPECT_EQ(difference->unchanged, static_cast<int>(registry.markers.size()));
}

TEST(WeakestLinks, lie_between_rows_that_nothing_ties_together) {
  const std::vector<Vec2> rows_only = mower_lanes(8.0, 6.0, 2.0, 1.0);
  const SurveyWorld world = make_survey_world(marker_grid(8.0, 6.0, 2.0, ceiling_m, 5), {}, 21);
  const SurveyDrive drive = drive_survey(world, rows_only, 21);
  const MarkerSurvey survey = survey_markers(std::span(&drive.log, 1), world.camera, world.belief,
                                             exact_print(), {.most_sigma_m = 1.0});
  ASSERT_TRUE(survey.flaws.empty()) << words_of(survey);
  const std::vector<MarkerLink> links = weakest_links(survey);
  ASSERT_FALSE(links.empty());
  const MarkerLink& weakest = links.front();
  const auto at = [&](int id) {
    return std::ranges::find(world.markers, id, &RegisteredMarker::id)->position_m;
  };
  EXPECT_NEAR(at(weakest.first).x(), at(weakest.second).x(), 1.0) << "one above the other";
  EXPECT_NEAR(std::abs(at(weakest.first).y() - at(weakest.second).y()), 2.0, 0.7) << "of neighbouring rows";
}

}  // namespace
}  // namespace lodestar
