#include "app/placement/map_from_runs.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/recording/scan_log.hpp"
#include "maps/distance_field.hpp"
#include "maps/input_error.hpp"
#include "maps/map_file.hpp"

#include "tests/maps/cast_scan.hpp"
#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

const ScannerMount mount{.base_from_scanner = {{0.15, 0.02}, 0.3}, .height_m = 0.2};

OccupancyMap lab() {
  return load_map(std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/map.yaml").map;
}

/// A drive that stands at each of its points and turns once around there. Poses have no kinks in position.
struct Track {
  std::vector<Vec2> points_m;
  double turn_s = 6.0;

  [[nodiscard]] double length_s() const { return turn_s * static_cast<double>(points_m.size()); }
  [[nodiscard]] Pose2 at(Stamp stamp) const {
    const double time_s = std::clamp(seconds(stamp), 0.0, length_s() - 1e-6);
    const auto point = static_cast<std::size_t>(time_s / turn_s);
    return {points_m[point], wrap_angle(2.0 * std::numbers::pi * time_s / turn_s)};
  }
};

/// Free places of the lab, half a metre apart, that are 0.3 m from everything.
Track grid_track(const OccupancyMap& map) {
  const DistanceField field(map);
  Track track;
  for (double x_m = 0.5; x_m < 15.0; x_m += 1.0)
    for (double y_m = 0.5; y_m < 7.4; y_m += 1.0)
      if (field.distance_m(map.cell_at({x_m, y_m})) > 0.3) track.points_m.push_back({x_m, y_m});
  return track;
}

/// scans.bin by the real writer, estimate.tum as a run leaves it, with 1 cm of noise in range and pose.
void write_run(const std::filesystem::path& folder, const OccupancyMap& map, const Track& track,
               std::uint64_t seed) {
  Random random(seed);
  std::ofstream tum(folder / "estimate.tum");
  for (double time_s = 0.0; time_s < track.length_s() + 0.2; time_s += 0.02) {
    const Pose2 pose = track.at(Stamp(from_seconds(time_s)));
    fmt::print(tum, "{:.9f} {:.6f} {:.6f} 0.000000 0.000000000 0.000000000 {:.9f} {:.9f}\n", time_s,
               pose.position_m.x() + 0.01 * random.normal() * 0.7,
               pose.position_m.y() + 0.01 * random.normal() * 0.7, std::sin(0.5 * pose.yaw_rad),
               std::cos(0.5 * pose.yaw_rad));
  }
  ScanLog log(folder, mount, {.can_wait = true});
  for (double time_s = 0.0; time_s < track.length_s(); time_s += 0.5) {
    const Stamp begin{from_seconds(time_s)};
    const Scan scan = testing::cast_scan(
        map, {}, begin, [&](Stamp at) { return track.at(at) * mount.base_from_scanner; }, random);
    log.take({.now = begin + std::chrono::milliseconds(130), .scans = {scan}});
  }
  ASSERT_EQ(log.finish(), "");
}

/// Cells of one map within one cell of an occupied one of the other.
bool is_beside_occupied(const OccupancyMap& map, const Vec2& point_in_map) {
  const Cell at = map.cell_at(point_in_map);
  for (int row = at.row - 1; row <= at.row + 1; ++row)
    for (int column = at.column - 1; column <= at.column + 1; ++column)
      if (map.contains({column, row}) && map.at({column, row}) == OccupancyMap::occupied) return true;
  return false;
}

TEST(MapFromRuns, has_the_walls_of_the_lab_where_they_are) {
  const OccupancyMap truth = lab();
  const Track track = grid_track(truth);
  const TemporaryFolder folder;
  write_run(folder.path(), truth, track, 7);
  const MapFromRuns built = map_from_runs(std::vector{folder.path()}, {});

  int occupied = 0;
  int true_ones = 0;
  int exact = 0;
  for (int row = 0; row < built.map.rows; ++row) {
    for (int column = 0; column < built.map.columns; ++column) {
      if (built.map.at({column, row}) != OccupancyMap::occupied) continue;
      const Vec2 at = built.map.center_of({column, row});
      const Cell there = truth.cell_at(at);
      ++occupied;
      true_ones += is_beside_occupied(truth, at) ? 1 : 0;
      exact += truth.contains(there) && truth.at(there) == OccupancyMap::occupied ? 1 : 0;
    }
  }
  // A wall cell counts as seen where an exact beam from a point of the track ends in it, up to 5 m away.
  std::vector<int> beams_at(truth.cells.size(), 0);
  for (const Vec2& from : track.points_m) {
    for (int i = 0; i < 360; ++i) {
      const double heading_rad = radians(i);
      const auto range_m = testing::range_in_map_m(truth, from, heading_rad, 5.0);
      if (!range_m) continue;
      const Vec2 end = from + (*range_m + 0.002) * Vec2(std::cos(heading_rad), std::sin(heading_rad));
      if (truth.contains(truth.cell_at(end))) ++beams_at[truth.index(truth.cell_at(end))];
    }
  }
  int seen = 0;
  int found = 0;
  for (int row = 0; row < truth.rows; ++row) {
    for (int column = 0; column < truth.columns; ++column) {
      if (beams_at[truth.index({column, row})] < 3) continue;
      ++seen;
      found += is_beside_occupied(built.map, truth.center_of({column, row})) ? 1 : 0;
    }
  }
  const std::string figures = fmt::format(
      "{} scans; {} cells occupied, {} within a cell of a wall, {} in one; {} wall cells seen, {} found",
      built.runs.front().counts.used, occupied, true_ones, exact, seen, found);
  RecordProperty("figures", figures);
  ASSERT_GT(occupied, 500) << figures;
  ASSERT_GT(seen, 500) << figures;
  EXPECT_GE(true_ones, 0.99 * occupied) << figures;
  EXPECT_GE(exact, 0.8 * occupied) << figures;
  EXPECT_GE(found, 0.99 * seen) << figures;
  int walls_made_free = 0;
  for (int row = 0; row < built.map.rows; ++row)
    for (int column = 0; column < built.map.columns; ++column) {
      const Cell there = truth.cell_at(built.map.center_of({column, row}));
      const bool is_inside_wall = truth.contains(there) && truth.at(there) == OccupancyMap::occupied;
      walls_made_free += is_inside_wall && built.map.at({column, row}) == OccupancyMap::free ? 1 : 0;
    }
  EXPECT_LE(walls_made_free, 0.01 * seen) << figures;
}

TEST(MapFromRuns, joins_runs_and_says_where_the_map_comes_from) {
  const OccupancyMap truth = lab();
  const TemporaryFolder first;
  const TemporaryFolder second;
  write_run(first.path(), truth, {.points_m = {{1.2, 5.6}}}, 1);
  write_run(second.path(), truth, {.points_m = {{13.9, 2.0}}}, 2);
  first.write("run.yaml", "started: 2026-11-24T12:00:00Z\nsite: lab\n");
  const MapFromRuns built = map_from_runs(std::vector{first.path(), second.path()}, {});
  EXPECT_EQ(built.map.at(built.map.cell_at({1.2, 5.6})), OccupancyMap::free);
  EXPECT_EQ(built.map.at(built.map.cell_at({13.9, 2.0})), OccupancyMap::free);
  ASSERT_EQ(built.runs.size(), 2U);
  const TemporaryFolder out;
  save_map(built.map, out / "map.yaml", provenance_comment(built));
  EXPECT_EQ(load_map(out / "map.yaml").map.cells, built.map.cells);
  const std::string yaml = out.read("map.yaml");
  EXPECT_THAT(yaml, HasSubstr(first.path().string() + ": started 2026-11-24T12:00:00Z, 12 of 12 scans"));
  EXPECT_THAT(yaml, HasSubstr(second.path().string() + ": 12 of 12 scans"));
}

std::string refusal_of(const std::filesystem::path& run) {
  try {
    map_from_runs(std::vector{run}, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(MapFromRuns, refuses_runs_without_scans_or_poses) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal_of(folder / "none"), HasSubstr("no such folder"));
  EXPECT_THAT(refusal_of(folder.path()), HasSubstr("scans.bin"));
  write_run(folder.path(), lab(), {.points_m = {{1.2, 5.6}}}, 1);
  EXPECT_EQ(refusal_of(folder.path()), "");
  const std::string poses = folder.read("estimate.tum");
  folder.write("estimate.tum", poses + "7 1 2 3\n");
  EXPECT_THAT(refusal_of(folder.path()), HasSubstr("estimate.tum:"));
  folder.write("estimate.tum", "99 1 1 0 0 0 0 1\n");
  EXPECT_THAT(refusal_of(folder.path()), HasSubstr("no scan that has a pose"));
  folder.write("estimate.tum", "");
  EXPECT_THAT(refusal_of(folder.path()), HasSubstr("without a pose"));
  folder.write("estimate.tum", poses);
  folder.write("scans.bin", scan_file_header(mount));
  EXPECT_THAT(refusal_of(folder.path()), HasSubstr("no scan"));
}

TEST(MapFromRuns, leaves_out_what_was_seen_while_the_pose_was_not_sure) {
  const TemporaryFolder folder;
  write_run(folder.path(), lab(), {.points_m = {{1.2, 5.6}}}, 1);
  std::string steps =
      "stamp_s,x_m,y_m,yaw_deg,sigma_m,sigma_yaw_deg,commanded_mps,commanded_degps,driven_mps,driven_degps\n";
  for (double time_s = 0.0; time_s < 6.3; time_s += 0.02)
    steps += fmt::format("{:.4f},1.2,5.6,{:.3f},{},0.1,0,0,0,0\n", time_s, 60.0 * time_s,
                         time_s < 3.0 ? 0.005 : 0.1);
  folder.write("steps.csv", steps);
  const RunScans run = map_from_runs(std::vector{folder.path()}, {}).runs.front();
  EXPECT_EQ(run.counts.scans, 12U);
  EXPECT_EQ(run.counts.used, 6U);
  EXPECT_EQ(run.counts.without_pose, 6U);
}

TEST(MapFromRuns, reads_steps_of_every_version_and_refuses_one_that_is_cut_short) {
  const TemporaryFolder folder;
  write_run(folder.path(), lab(), Track{{{2.5, 5.0}}}, 5);
  const auto steps = [&](const std::string& header, const std::string& cells) {
    std::ofstream file(folder / "steps.csv");
    file << header << "\n";
    for (double time_s = 0.0; time_s < 6.0; time_s += 0.02)
      fmt::print(file, "{:.4f},2.5,5.0,0,0.005,0.1,{}\n", time_s, cells);
  };
  const std::string first = "stamp_s,x_m,y_m,yaw_deg,sigma_m,sigma_yaw_deg,commanded_mps,commanded_degps";
  for (const auto& [header, cells] : std::vector<std::pair<std::string, std::string>>{
           {first, "0,0"}, {first + ",driven_mps,driven_degps,xx_m2,xy_m2,yy_m2", "0,0,0,0,1e-5,0,1e-5"}}) {
    steps(header, cells);
    EXPECT_GT(map_from_runs(std::vector{folder.path()}, {}).runs.front().counts.used, 0U) << header;
  }
  steps(first, "0");
  EXPECT_THROW(map_from_runs(std::vector{folder.path()}, {}), InputError);
}

}  // namespace
}  // namespace lodestar
