#include "app/placement/live_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/simulation/disc_contact.hpp"
#include "maps/input_error.hpp"
#include "maps/map_file.hpp"

#include "tests/maps/cast_scan.hpp"
#include "tests/maps/temporary_folder.hpp"

// A robot that turns on the spot in the lab, once in six seconds, and sees twice a second.
namespace lodestar {
namespace {

using ::testing::HasSubstr;

const ScannerMount mount{.base_from_scanner = {{0.15, 0.02}, 0.3}, .height_m = 0.2};
const Vec2 place_m{1.2, 5.6};

OccupancyMap lab() {
  return load_map(std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/map.yaml").map;
}

Pose2 pose_at(Stamp stamp) {
  return {place_m, wrap_angle(2.0 * std::numbers::pi * seconds(stamp) / 6.0)};
}

class LiveMapTest : public ::testing::Test {
 protected:
  /// Scans come 30 ms after their last beam, each pose with its own step.
  void turn(LiveMap& map, double until_s, double sigma_m = 0.003) {
    for (; now_ < Stamp(from_seconds(until_s)); now_ += std::chrono::milliseconds(20)) {
      std::vector<Scan> arrived;
      if (now_ >= arrives_) {
        arrived.push_back(testing::cast_scan(
            truth_, {}, begins_, [](Stamp at) { return pose_at(at) * mount.base_from_scanner; }, random_));
        begins_ += std::chrono::milliseconds(500);
        arrives_ = begins_ + std::chrono::milliseconds(130);
      }
      PoseEstimate estimate{.stamp = now_, .map_from_base = pose_at(now_)};
      estimate.covariance = Vec3(sigma_m * sigma_m, sigma_m * sigma_m, 1e-6).asDiagonal();
      map.take(arrived, estimate);
    }
  }

  OccupancyMap truth_ = lab();
  Random random_{1};
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "built.yaml";
  Stamp now_;
  Stamp begins_;
  Stamp arrives_ = Stamp{} + std::chrono::milliseconds(130);
};

TEST_F(LiveMapTest, is_written_while_the_robot_drives_and_at_the_end) {
  LiveMap map(file_, mount, {.made_by = "a test", .period = std::chrono::seconds(4), .can_wait = true});
  turn(map, 3.0);
  EXPECT_FALSE(std::filesystem::exists(file_));
  turn(map, 9.0);
  turn(map, 20.0);
  ASSERT_EQ(map.finish(), "");
  EXPECT_THAT(folder_.read("built.yaml"),
              HasSubstr("# built by a test while the robot drove, at 0.05 m, from "));
  EXPECT_GE(map.counts().used, 35U);
  EXPECT_EQ(map.counts().without_pose, 0U);
  const OccupancyMap built = load_map(file_).map;
  EXPECT_EQ(built.at(built.cell_at(place_m)), OccupancyMap::free);
  int occupied = 0;
  int true_ones = 0;
  for (int row = 0; row < built.rows; ++row)
    for (int column = 0; column < built.columns; ++column) {
      if (built.at({column, row}) != OccupancyMap::occupied) continue;
      ++occupied;
      true_ones += disc_overlaps_obstacle(truth_, built.center_of({column, row}), 0.05) ? 1 : 0;
    }
  EXPECT_GT(occupied, 200);
  EXPECT_GE(true_ones, 0.99 * occupied);
}

TEST_F(LiveMapTest, leaves_out_what_was_seen_while_the_pose_was_not_sure) {
  LiveMap map(file_, mount, {.can_wait = true});
  turn(map, 6.0, 0.1);
  EXPECT_THAT(map.finish(), HasSubstr("no scan that has a pose"));
  EXPECT_GE(map.counts().without_pose, 10U);
  EXPECT_FALSE(std::filesystem::exists(file_));
}

/// An hour of scans would fill a gigabyte.
TEST_F(LiveMapTest, keeps_no_scans_of_a_robot_that_is_lost) {
  LiveMap map(file_, mount, {.can_wait = true});
  for (int i = 0; i < 60; ++i) {
    const Stamp begin = Stamp{} + i * std::chrono::milliseconds(500);
    map.take({testing::cast_scan(
                 truth_, {}, begin, [](Stamp at) { return pose_at(at) * mount.base_from_scanner; }, random_)},
             std::nullopt);
  }
  EXPECT_THAT(map.finish(), HasSubstr("no scan that has a pose"));
  EXPECT_GE(map.counts().without_pose, 57U);
}

TEST_F(LiveMapTest, needs_a_folder_to_write_to_and_a_name_of_a_yaml_file) {
  EXPECT_THROW(LiveMap(folder_ / "built.png", mount), InputError);
  EXPECT_THROW(LiveMap(folder_ / "none" / "built.yaml", mount), InputError);
}

TEST_F(LiveMapTest, says_what_the_disk_did_not_take) {
  std::filesystem::create_directory(file_);
  LiveMap map(file_, mount, {.can_wait = true});
  turn(map, 6.0);
  EXPECT_THAT(map.finish(), HasSubstr("built.yaml"));
}

}  // namespace
}  // namespace lodestar
