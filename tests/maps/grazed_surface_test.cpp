#include "maps/grazed_surface.hpp"

#include <cstddef>
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

#include "maps/obstacle_memory.hpp"
#include "maps/random.hpp"

#include "tests/maps/disc_scan.hpp"

namespace lodestar {
namespace {

using testing::scan_of;
using testing::ScanDisc;

/// Along y, so far beside the scanner: posts of 8 cm that touch.
std::vector<ScanDisc> row_beside(double aside_m, int posts = 40) {
  std::vector<ScanDisc> row;
  for (int i = 0; i < posts; ++i) row.push_back({{aside_m + 0.04, 0.45 + 0.076 * i}, 0.04});
  return row;
}

/// In scans whose beams lie elsewhere each time, as those of a robot that is about to turn.
DeskewedScan turned_scan(std::vector<ScanDisc> discs, double at_s, Random& random) {
  const Pose2 turn{Vec2::Zero(), radians(0.5) * random.uniform()};
  for (ScanDisc& disc : discs) disc.center_m = inverse(turn) * disc.center_m;
  DeskewedScan scan = scan_of(discs, at_s, random);
  for (Ray& ray : scan.rays) ray.end_m = turn * ray.end_m;
  return scan;
}

struct Counted {
  int hits = 0;
  int standing = 0;
};

/// From 1.1 to 1.7 m away, after legs would stand too.
template <typename Look>
Counted count_on_row(const Look& look) {
  Counted counted;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    Random random(seed);
    ObstacleMemory memory;
    for (int scans = 0; scans < 200; ++scans) {
      const DeskewedScan scan = look(0.1 * scans, random);
      memory.add(scan);
      if (scans < 130) continue;
      const std::vector<bool> stands = memory.standing(scan);
      for (std::size_t i = 0; i < stands.size(); ++i) {
        const double away_m = range_m(scan.rays[i]);
        if (!ends_at_something(scan.rays[i]) || away_m < 1.1 || away_m > 1.7) continue;
        ++counted.hits;
        counted.standing += stands[i] ? 1 : 0;
      }
    }
  }
  return counted;
}

/// As a robot sees it that stands in a gap of it: each ray passes close by what the one beside it hits. It
/// took parts of the row for people, a metre away, and neither drove on nor turned.
TEST(GrazedSurface, StandsThoughRaysPassCloseBy) {
  for (const double aside_m : {0.09, 0.13}) {
    const std::vector<ScanDisc> row = row_beside(aside_m);
    const Counted counted =
        count_on_row([&](double at_s, Random& random) { return scan_of(row, at_s, random); });
    EXPECT_GT(counted.standing, 0.99 * counted.hits)
        << "of " << counted.hits << ", " << aside_m << " m aside";
  }
}

TEST(GrazedSurface, StandsThoughRaysHitItNowHereNowThere) {
  for (const double aside_m : {0.05, 0.07}) {
    const std::vector<ScanDisc> row = row_beside(aside_m);
    const Counted counted =
        count_on_row([&](double at_s, Random& random) { return turned_scan(row, at_s, random); });
    EXPECT_GT(counted.standing, 0.9 * counted.hits) << "of " << counted.hits << ", " << aside_m << " m aside";
  }
}

/// Who walks out from behind the end of a wall beside the robot, across its line.
TEST(GrazedSurface, IsNotWhoWalksOutBehindItsEnd) {
  int hits = 0;
  int standing = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    Random random(seed);
    ObstacleMemory memory;
    for (int scans = 0; scans < 150; ++scans) {
      std::vector<ScanDisc> discs = row_beside(0.07, 8);  // to a metre
      const Vec2 walker_m(0.5 - 0.05 * (scans - 135), 1.3);
      if (scans >= 130) discs.push_back({walker_m, 0.15});
      const DeskewedScan scan = turned_scan(discs, 0.1 * scans, random);
      memory.add(scan);
      if (scans < 130) continue;
      const std::vector<bool> stands = memory.standing(scan);
      for (std::size_t i = 0; i < stands.size(); ++i) {
        const bool hits_them = ends_at_something(scan.rays[i]) && scan.rays[i].end_m.y() > 1.1;
        hits += hits_them ? 1 : 0;
        standing += hits_them && stands[i] ? 1 : 0;
      }
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_LE(standing, 0.02 * hits);
}

class GrazedSurfaceTest : public ::testing::Test {
 protected:
  /// From the origin.
  [[nodiscard]] bool leads_to(const Vec2& end_m) const {
    return surface_.leads_to({Stamp{}, Vec2::Zero(), end_m, Echo::hit});
  }

  GrazedSurface surface_;
};

TEST_F(GrazedSurfaceTest, LeadsOnAfterThirtyCentimetres) {
  for (const double y_m : {0.6, 0.7, 0.8}) {
    surface_.add({0.05, y_m});
    EXPECT_FALSE(leads_to({0.05, y_m + 0.1})) << y_m;
  }
  surface_.add({0.05, 0.91});
  EXPECT_TRUE(leads_to({0.05, 1.2}));
  EXPECT_TRUE(leads_to({0.07, 1.2}));
  EXPECT_FALSE(leads_to({0.1, 1.2})) << "beside it";
  EXPECT_FALSE(leads_to({0.05, 1.4})) << "too far on";
  EXPECT_FALSE(leads_to({0.05, 0.8})) << "back";
  surface_.add({0.05, 1.4});
  EXPECT_FALSE(leads_to({0.05, 1.5})) << "of another thing";
}

TEST_F(GrazedSurfaceTest, IsNoneThatIsSeenFromTheFront) {
  for (const double y_m : {-0.2, 0.0, 0.2}) surface_.add({1.0, y_m});
  EXPECT_FALSE(leads_to({1.0, 0.4}));
}

}  // namespace
}  // namespace lodestar
