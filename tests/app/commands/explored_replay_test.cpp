#include "app/commands/explored_replay.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "app/frames/survey_log_file.hpp"
#include "app/placement/survey_report.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

/// A part of the lab, closed by a wall: 5 x 7.5 m.
Site part_of_the_lab() {
  Site site = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  OccupancyMap& map = site.map.map;
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column)
      if (map.center_of({column, row}).x() > 5.0)
        map.cells[map.index({column, row})] = OccupancyMap::occupied;
  std::erase_if(site.registry.markers,
                [](const RegisteredMarker& marker) { return marker.position_m.x() > 4.6; });
  return site;
}

/// Best rigid alignment of two lists of points, and what it leaves: root mean square.
double rms_after_alignment(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  Vec2 mean_a = Vec2::Zero();
  Vec2 mean_b = Vec2::Zero();
  const auto count = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / count;
    mean_b += b[i] / count;
  }
  Vec2 turn = Vec2::Zero();
  for (std::size_t i = 0; i < a.size(); ++i)
    turn += Vec2((a[i] - mean_a).dot(b[i] - mean_b), cross(a[i] - mean_a, b[i] - mean_b));
  const Eigen::Rotation2Dd rotation(heading_of(turn));
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    squares += (rotation * (a[i] - mean_a) - (b[i] - mean_b)).squaredNorm();
  return std::sqrt(squares / count);
}

/// The robot is told where it stands, and nothing of any marker.
TEST(ExploredReplay, surveys_every_marker_without_knowing_any_and_without_a_contact) {
  const Site site = part_of_the_lab();
  const TemporaryFolder folder;
  ASSERT_EQ(replay_exploring(site, {.camera = site.default_camera, .seed = 3}, folder / "log"), done);
  const CameraModel& camera = site.cameras.at(site.default_camera);
  const SurveyLog log = load_survey_log(folder / "log", camera);
  const Anchors exact_print{.print_scale = {1.0, 1e-4}};
  const MarkerSurvey survey =
      survey_markers(std::span(&log, 1), camera, survey_belief_of(site.robot), exact_print);
  ASSERT_TRUE(survey.flaws.empty()) << survey.flaws.front().found;
  ASSERT_EQ(survey.markers.size(), site.registry.markers.size());
  std::vector<Vec2> found;
  std::vector<Vec2> true_places;
  for (const RegisteredMarker& marker : survey.markers) {
    found.emplace_back(marker.position_m.head<2>());
    true_places.emplace_back(site.registry.find(marker.id)->position_m.head<2>());
  }
  EXPECT_LT(rms_after_alignment(found, true_places), 0.0015);
}

}  // namespace
}  // namespace lodestar
