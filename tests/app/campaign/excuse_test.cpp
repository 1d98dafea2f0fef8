#include "app/campaign/excuse.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

Stamp at(double time_s) {
  return Stamp(from_seconds(time_s));
}

/// An empty floor of 8 x 4 m that ends at walls, with one marker over this place.
Site floor_with_marker_at(const Vec2& place_m) {
  Site site = load_site(std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab");
  OccupancyMap& map = site.map.map;
  map = {.columns = 160, .rows = 80, .resolution_m = 0.05, .map_from_grid = {}, .cells = {}};
  map.cells.assign(160UL * 80UL, OccupancyMap::free);
  site.registry = {};
  site.registry.markers = {{.id = 447, .position_m = {place_m.x(), place_m.y(), 2.6}}};
  return site;
}

/// Rolls along the middle of the floor from x = 7 m on until it touches the wall at 8 m, some 3 s later.
RunRecord drive_into_wall(const Site& site, FaultKind fault, double begins_s) {
  RunRecord record;
  record.camera = site.default_camera;
  for (int i = 0; i < 200; ++i) {
    const double x_m = std::min(7.0 + 0.005 * i, 8.0 - site.robot.radius_m);
    record.truth.push_back({at(0.02 * i), {{x_m, 2.0}, 0.0}});
  }
  record.faults = {{.kind = fault, .begin = at(begins_s), .end = std::nullopt, .marker = std::nullopt}};
  return record;
}

/// Elsewhere than where the robot is.
FixRecord fix_by(int id, double time_s) {
  return {.stamp = at(time_s), .map_from_base = {}, .ids = {id}, .confidence = 0.9, .accepted = true};
}

TEST(Excuse, is_a_robot_put_down_where_no_marker_was_in_view) {
  const Site far = floor_with_marker_at({1.0, 1.0});
  const Site near = floor_with_marker_at({7.5, 2.0});
  EXPECT_TRUE(excuse_for_contact(drive_into_wall(far, FaultKind::kidnapping, 0.5), far));
  EXPECT_FALSE(excuse_for_contact(drive_into_wall(near, FaultKind::kidnapping, 0.5), near));
  EXPECT_FALSE(excuse_for_contact(drive_into_wall(far, FaultKind::wheel_slip, 0.5), far))
      << "the ceiling shows it";
  EXPECT_FALSE(excuse_for_contact(drive_into_wall(far, FaultKind::kidnapping, 3.9), far)) << "after it";
}

TEST(Excuse, is_a_first_and_only_marker_that_had_been_tampered_with_before) {
  const Site site = floor_with_marker_at({7.5, 2.0});
  RunRecord record = drive_into_wall(site, FaultKind::marker_wrong_id, 0.5);
  record.fixes = {fix_by(447, 1.0), fix_by(447, 2.0)};
  EXPECT_TRUE(excuse_for_contact(record, site));
  record.fixes = {fix_by(447, 1.0), fix_by(620, 2.0)};
  EXPECT_FALSE(excuse_for_contact(record, site)) << "another marker could have told";
  record.fixes = {fix_by(447, 0.2), fix_by(447, 2.0)};
  EXPECT_FALSE(excuse_for_contact(record, site)) << "it had a pose before";
  record.fixes = {fix_by(447, 1.0)};
  record.fixes[0].map_from_base = {{7.25, 2.0}, 0.0};
  EXPECT_FALSE(excuse_for_contact(record, site)) << "another marker than the one it goes by";
}

TEST(Excuse, needs_a_contact) {
  const Site site = floor_with_marker_at({1.0, 1.0});
  RunRecord record = drive_into_wall(site, FaultKind::kidnapping, 0.5);
  record.truth.resize(50);
  EXPECT_FALSE(excuse_for_contact(record, site));
}

}  // namespace
}  // namespace lodestar
