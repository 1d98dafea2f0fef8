#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/bench/survey_bench.hpp"

// A small room and a drive through it, to be surveyed.
namespace lodestar::survey_sample {

inline constexpr double ceiling_m = 2.6;

struct SurveyTour {
  SurveyWorld world;
  SurveyDrive drive;
};

/// Lanes both ways through a room.
inline std::vector<Vec2> lanes(double width_m, double depth_m) {
  std::vector<Vec2> way = mower_lanes(width_m, depth_m, 1.2, 0.8);
  const std::vector<Vec2> cross = cross_lanes(width_m, depth_m, 2.0, 0.8);
  way.insert(way.end(), cross.begin(), cross.end());
  return way;
}

/// A room of 6 x 4 m with six markers.
inline SurveyTour small_tour(std::uint64_t seed, const SurveyWorldOptions& options = {}) {
  SurveyTour tour{.world = make_survey_world(marker_grid(6.0, 4.0, 2.0, ceiling_m, 5), options, seed)};
  tour.drive = drive_survey(tour.world, lanes(6.0, 4.0), seed);
  return tour;
}

inline Anchors exact_print() {
  return {.print_scale = {1.0, 1e-4}};
}

inline MarkerSurvey survey_of(const SurveyTour& tour, const Anchors& anchors = exact_print(),
                              const SurveyOptions& options = {}) {
  return survey_markers(std::span(&tour.drive.log, 1), tour.world.camera, tour.world.belief, anchors,
                        options);
}

inline std::string words_of(const MarkerSurvey& survey) {
  return survey.flaws.empty() ? "" : survey.flaws.front().found;
}

inline std::vector<SurveyFlaw> flaws_of(const MarkerSurvey& survey) {
  std::vector<SurveyFlaw> flaws;
  for (const SurveyRefusal& refusal : survey.flaws) flaws.push_back(refusal.flaw);
  return flaws;
}

}  // namespace lodestar::survey_sample
