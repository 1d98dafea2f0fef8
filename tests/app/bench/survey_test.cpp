#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "app/bench/survey_bench.hpp"
#include "maps/random.hpp"

#include "tests/app/bench/survey_tour.hpp"

namespace lodestar {
namespace {

using namespace survey_sample;

Anchor at_its_place(const RegisteredMarker& marker, double sigma_m = 0.003) {
  return {MarkerAnchor{.id = marker.id, .position_m = marker.position_m.head<2>(), .sigma_m = sigma_m}, 7};
}

TEST(Survey, errors_are_at_their_bound_and_covariances_true_over_many_seeds) {
  double squares = 0.0;
  double bound = 0.0;
  double nees = 0.0;
  double freedom = 0.0;
  constexpr int seeds = 16;
  const SurveyScenario lanes{
      .name = "", .width_m = 8.0, .depth_m = 5.0, .way_m = mower_lanes(8.0, 5.0, 1.3, 0.8)};
  for (int seed = 1; seed <= seeds; ++seed) {
    const SurveyTrial trial = try_survey(lanes, static_cast<std::uint64_t>(seed));
    ASSERT_FALSE(trial.refused) << "seed " << seed << ": " << trial.why;
    squares += square(trial.errors.rms_m);
    bound += square(trial.bound_m);
    nees += trial.errors.nees;
    freedom += trial.errors.freedom;
  }
  EXPECT_LT(std::sqrt(squares / bound), 1.15);
  EXPECT_THAT(nees / freedom, testing::AllOf(testing::Gt(0.8), testing::Lt(1.25)));
}

TEST(Survey, finds_the_mount_and_the_wheels) {
  const SurveyTour tour = small_tour(3);
  const MarkerSurvey survey = survey_of(tour);
  ASSERT_TRUE(survey.flaws.empty()) << words_of(survey);
  const Vec3 off =
      survey.mount.base_from_camera.translation() - tour.world.options.base_from_camera.translation();
  EXPECT_LT(std::abs(off.x()), 5.0 * survey.mount.position_sigmas_m.x());
  EXPECT_LT(std::abs(off.y()), 5.0 * survey.mount.position_sigmas_m.y());
  EXPECT_LT(survey.mount.position_sigmas_m.head<2>().maxCoeff(), 0.002);
  EXPECT_NEAR(survey.mount.left_scale, tour.world.options.wheel_scales.x(), 0.003);
  EXPECT_NEAR(survey.mount.right_scale, tour.world.options.wheel_scales.y(), 0.003);
}

TEST(Survey, anchors_put_it_onto_the_map_however_the_drive_began) {
  const SurveyTour tour = small_tour(4);
  Anchors anchors = exact_print();
  anchors.anchors = {at_its_place(tour.world.markers.front()), at_its_place(tour.world.markers.back())};
  const MarkerSurvey survey = survey_of(tour, anchors);
  ASSERT_TRUE(survey.flaws.empty()) << words_of(survey);
  EXPECT_EQ(survey.gauge, SurveyGauge::anchored);
  for (std::size_t m = 0; m < survey.markers.size(); ++m) {
    const auto& truth = *std::ranges::find(tour.world.markers, survey.markers[m].id, &RegisteredMarker::id);
    EXPECT_LT((survey.markers[m].position_m - truth.position_m).head<2>().norm(), 0.006);
    EXPECT_NEAR(wrap_angle(survey.markers[m].yaw_rad - truth.yaw_rad), 0.0, radians(0.3));
  }
}

TEST(Survey, a_place_where_the_robot_stood_is_an_anchor) {
  const SurveyTour tour = small_tour(5);
  const std::size_t frame = tour.drive.log.frames.size() / 2;
  const Pose2& there = tour.drive.map_from_base[frame];
  Anchors anchors = exact_print();
  anchors.anchors = {{RobotAnchor{.at_s = seconds(tour.drive.log.frames[frame].stamp),
                                  .position_m = there.position_m,
                                  .sigma_m = 0.002,
                                  .yaw = AnchorYaw{there.yaw_rad, radians(0.05)}},
                      3}};
  const MarkerSurvey survey = survey_of(tour, anchors);
  ASSERT_TRUE(survey.flaws.empty()) << words_of(survey);
  for (const RegisteredMarker& marker : survey.markers) {
    const auto& truth = *std::ranges::find(tour.world.markers, marker.id, &RegisteredMarker::id);
    EXPECT_LT((marker.position_m - truth.position_m).head<2>().norm(), 0.015);
  }
}

TEST(Survey, takes_a_step_in_the_ceiling) {
  const SurveyTour tour = small_tour(6, {.step_m = 0.35});
  const MarkerSurvey survey = survey_of(tour);
  ASSERT_TRUE(survey.flaws.empty()) << words_of(survey);
  EXPECT_LT(survey_errors(survey, tour.world.markers).rms_m, 0.002);
  for (const RegisteredMarker& marker : survey.markers) {
    const auto& truth = *std::ranges::find(tour.world.markers, marker.id, &RegisteredMarker::id);
    EXPECT_NEAR(marker.position_m.z(), truth.position_m.z(), 0.01);
  }
}

TEST(Survey, joins_drives_of_two_days) {
  SurveyTour tour = small_tour(7);
  const std::vector<Vec2> back{{5.0, 3.0}, {1.0, 1.0}};
  const SurveyDrive second = drive_survey(tour.world, back, 8);
  std::vector<SurveyLog> logs{tour.drive.log, second.log};
  logs[0].name = "monday";
  logs[1].name = "tuesday";
  const MarkerSurvey survey = survey_markers(logs, tour.world.camera, tour.world.belief, exact_print());
  ASSERT_TRUE(survey.flaws.empty()) << words_of(survey);
  EXPECT_LT(survey_errors(survey, tour.world.markers).rms_m, 0.002);
}

TEST(SurveyRefusals, too_few_sightings_name_the_marker) {
  SurveyTour tour = small_tour(9);
  const int id = tour.world.markers.front().id;
  int seen = 0;
  for (SurveyFrame& frame : tour.drive.log.frames)
    std::erase_if(frame.markers, [&](const SightedMarker& marker) { return marker.id == id && ++seen > 1; });
  const MarkerSurvey survey = survey_of(tour);
  EXPECT_THAT(flaws_of(survey), testing::ElementsAre(SurveyFlaw::too_few_sightings));
  EXPECT_THAT(words_of(survey), testing::HasSubstr(std::to_string(id)));
}

/// One in which the camera's pictures are kept twice a second.
TEST(Survey, leaves_out_a_single_misreading_of_a_slow_log) {
  SurveyTour tour = small_tour(9, {.frames_hz = 2.0});
  const int id = tour.world.markers.front().id;
  std::vector<SurveyFrame>& frames = tour.drive.log.frames;
  const auto shows = [](const SurveyFrame& frame, int wanted) {
    return std::ranges::find(frame.markers, wanted, &SightedMarker::id) != frame.markers.end();
  };
  // Another marker's dots under this one's ID, far from where it is seen.
  for (std::size_t i = 2; i + 2 < frames.size(); ++i) {
    if (frames[i].markers.empty() || shows(frames[i - 1], id) || shows(frames[i], id) ||
        shows(frames[i + 1], id))
      continue;
    frames[i].markers.front().id = id;
    break;
  }
  const MarkerSurvey survey = survey_of(tour);
  EXPECT_TRUE(survey.flaws.empty()) << words_of(survey);
}

TEST(SurveyRefusals, drives_without_a_marker_in_common_are_not_connected) {
  SurveyTour tour = small_tour(10);
  SurveyDrive second = drive_survey(tour.world, {{5.0, 3.0}, {1.0, 1.0}}, 8);
  for (SurveyFrame& frame : second.log.frames)
    for (SightedMarker& marker : frame.markers) marker.id = (marker.id + 2048) % marker_id_count;
  const std::vector<SurveyLog> logs{tour.drive.log, second.log};
  const MarkerSurvey survey = survey_markers(logs, tour.world.camera, tour.world.belief, exact_print());
  EXPECT_THAT(flaws_of(survey), testing::Contains(SurveyFlaw::not_connected));
}

TEST(SurveyRefusals, an_unmeasured_print_leaves_the_scale_unknown) {
  const Anchors anchors{.print_scale = {1.0, 0.05}};
  EXPECT_THAT(flaws_of(survey_of(small_tour(11), anchors)), testing::Contains(SurveyFlaw::scale_unknown));
}

TEST(SurveyRefusals, a_measured_distance_gives_the_scale) {
  const SurveyTour tour = small_tour(11);
  const RegisteredMarker& a = tour.world.markers.front();
  const RegisteredMarker& b = tour.world.markers.back();
  Anchors anchors{.print_scale = {1.0, 0.05}};
  anchors.anchors = {{DistanceAnchor{a.id, b.id, (a.position_m - b.position_m).norm(), 0.002}, 2}};
  const MarkerSurvey survey = survey_of(tour, anchors);
  ASSERT_TRUE(survey.flaws.empty()) << words_of(survey);
  EXPECT_LT(std::abs(survey.print_scale - 1.0), 5.0 * survey.print_scale_sigma);
}

TEST(SurveyRefusals, one_marker_does_not_orient_a_registry) {
  const SurveyTour tour = small_tour(12);
  Anchors anchors = exact_print();
  anchors.anchors = {at_its_place(tour.world.markers.front())};
  EXPECT_THAT(flaws_of(survey_of(tour, anchors)), testing::ElementsAre(SurveyFlaw::orientation_unknown));
}

TEST(SurveyRefusals, what_is_asked_for_and_not_reached_is_weak) {
  EXPECT_THAT(flaws_of(survey_of(small_tour(13), exact_print(), {.most_sigma_m = 1e-5})),
              testing::ElementsAre(SurveyFlaw::weak));
}

TEST(SurveyRefusals, a_marker_that_was_moved_meanwhile_contradicts) {
  SurveyTour tour = small_tour(14);
  SurveyWorld later = tour.world;
  later.markers[2].position_m.x() += 0.03;
  const SurveyDrive second = drive_survey(later, {{5.0, 3.0}, {1.0, 3.0}, {1.0, 1.0}, {5.0, 1.0}}, 8);
  const std::vector<SurveyLog> logs{tour.drive.log, second.log};
  const MarkerSurvey survey = survey_markers(logs, tour.world.camera, tour.world.belief, exact_print());
  EXPECT_THAT(flaws_of(survey), testing::ElementsAre(SurveyFlaw::contradiction));
  EXPECT_THAT(words_of(survey), testing::HasSubstr(std::to_string(later.markers[2].id)));
}

TEST(SurveyRefusals, a_false_anchor_among_four_is_named) {
  const SurveyTour tour = small_tour(15);
  Anchors anchors = exact_print();
  for (const std::size_t m : {0U, 2U, 3U, 5U}) anchors.anchors.push_back(at_its_place(tour.world.markers[m]));
  std::get<MarkerAnchor>(anchors.anchors[2].what).position_m.y() += 0.08;
  const MarkerSurvey survey = survey_of(tour, anchors);
  EXPECT_THAT(flaws_of(survey), testing::ElementsAre(SurveyFlaw::anchors_contradict));
  EXPECT_THAT(words_of(survey), testing::HasSubstr(fmt::format("marker {} ", tour.world.markers[3].id)));
}

/// Four corner anchors with the errors of their sigmas; the first is off by more.
Anchors four_anchors(const SurveyTour& tour, std::uint64_t seed, const Vec2& off_m) {
  constexpr double sigma_m = 0.003;
  Random random(seed);
  const std::vector<RegisteredMarker>& markers = tour.world.markers;
  Anchors anchors = exact_print();
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}, markers.size() - 3, markers.size() - 1}) {
    anchors.anchors.push_back(at_its_place(markers[i], sigma_m));
    auto& position_m = std::get<MarkerAnchor>(anchors.anchors.back().what).position_m;
    position_m += sigma_m * Vec2(random.normal(), random.normal()) + (i == 0 ? off_m : Vec2::Zero());
  }
  return anchors;
}

TEST(SurveyRefusals, errors_of_anchors_are_found_from_the_size_that_it_says) {
  int at_the_size = 0;
  int at_a_third = 0;
  constexpr int seeds = 20;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const SurveyTour tour = small_tour(seed);
    const MarkerSurvey survey = survey_of(tour, four_anchors(tour, seed, Vec2::Zero()));
    ASSERT_EQ(survey.anchor_checks.size(), 4U) << words_of(survey);
    const double size_m = survey.anchor_checks.front().noticeable_m;
    EXPECT_GT(size_m, 3.0 * 0.003);
    EXPECT_LT(size_m, 0.1);
    const Vec2 direction = seed % 2 == 0 ? Vec2::UnitX() : Vec2::UnitY();
    const auto refused = [&](double share) {
      return !survey_of(tour, four_anchors(tour, seed, share * size_m * direction)).flaws.empty();
    };
    at_the_size += refused(1.0) ? 1 : 0;
    at_a_third += refused(1.0 / 3.0) ? 1 : 0;
  }
  EXPECT_GE(at_the_size, 0.6 * seeds) << "8 of 10 in the worst direction, more in others";
  EXPECT_LE(at_a_third, 0.2 * seeds);
}

TEST(SurveyRefusals, says_what_nothing_else_would_have_shown) {
  const SurveyTour tour = small_tour(12);
  EXPECT_TRUE(std::isinf(survey_of(tour).noticeable_print_scale));
  Anchors two = exact_print();
  two.anchors = {at_its_place(tour.world.markers.front()), at_its_place(tour.world.markers.back())};
  const MarkerSurvey by_two = survey_of(tour, two);
  ASSERT_EQ(by_two.anchor_checks.size(), 2U) << words_of(by_two);
  for (const AnchorCheck& check : by_two.anchor_checks) EXPECT_TRUE(std::isinf(check.noticeable_m));
  const MarkerSurvey by_four = survey_of(tour, four_anchors(tour, 12, Vec2::Zero()));
  EXPECT_LT(by_four.noticeable_print_scale, 0.1);
}

TEST(SurveyRefusals, one_id_at_two_places_is_named) {
  SurveyTour tour = small_tour(16);
  const int id = tour.world.markers[0].id;
  const int other = tour.world.markers[5].id;
  tour.drive = {};
  tour.world.markers[5].id = id;
  tour.drive = drive_survey(tour.world, mower_lanes(6.0, 4.0, 1.2, 0.8), 16);
  const MarkerSurvey survey = survey_of(tour);
  EXPECT_THAT(flaws_of(survey), testing::Contains(SurveyFlaw::same_id_twice)) << other;
  EXPECT_THAT(words_of(survey), testing::HasSubstr(fmt::format("marker {} ", id)));
}

TEST(SurveyRefusals, no_spoiled_log_gives_a_silently_wrong_registry) {
  int refused = 0;
  int logs = 0;
  for (const Spoiling spoiling : all_spoilings()) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed, ++logs) {
      const SpoiledTrial trial = try_spoiled(spoiling, seed);
      EXPECT_FALSE(trial.is_silently_wrong()) << to_string(spoiling) << ", seed " << seed;
      refused += trial.refused ? 1 : 0;
    }
  }
  EXPECT_GT(refused, logs / 3) << "enough of them are found out";
}

/// A corridor in which the camera never sees two markers at once, and often none.
TEST(Survey, bridges_blind_stretches_by_the_ceilings_own_motion) {
  const std::vector<Vec2> there_and_back{{0.5, 1.0}, {19.5, 1.0}, {0.5, 1.0}};
  double by_wheels = 0.0;
  double by_ceiling = 0.0;
  double nees = 0.0;
  double freedom = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const SurveyWorld world = make_survey_world(marker_grid(20.0, 2.0, 2.0, ceiling_m, seed),
                                                {.focal_px = 755.0, .follows_ceiling = true}, seed);
    SurveyDrive drive = drive_survey(world, there_and_back, seed);
    const auto errors_of = [&] {
      const MarkerSurvey survey = survey_markers(std::span(&drive.log, 1), world.camera, world.belief,
                                                 exact_print(), {.most_sigma_m = 1.0});
      EXPECT_TRUE(survey.flaws.empty()) << words_of(survey);
      return survey_errors(survey, world.markers);
    };
    const SurveyErrors with_ceiling = errors_of();
    drive.log.ceiling.clear();
    by_wheels += square(errors_of().rms_m);
    by_ceiling += square(with_ceiling.rms_m);
    nees += with_ceiling.nees;
    freedom += with_ceiling.freedom;
  }
  EXPECT_LT(by_ceiling, by_wheels / 9.0) << "a third of the error, or less";
  EXPECT_THAT(nees / freedom, testing::AllOf(testing::Gt(0.6), testing::Lt(1.4)));
}

}  // namespace
}  // namespace lodestar
