#include "maps/grazed_surface.hpp"

#include <cstddef>
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

#include "maps/obstacle_memory.hpp"
#include "maps/random.hpp"
#include "maps/standing_rays.hpp"

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

constexpr int scans_to_stand = 130;  ///< also as legs

/// Of the hits that `are_asked_for`, in the scans after those that it takes to stand.
template <typename Look, typename Asked>
Counted count_standing(int scans, const Look& look, const Asked& are_asked_for) {
  Counted counted;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    Random random(seed);
    ObstacleMemory memory;
    for (int scan_number = 0; scan_number < scans; ++scan_number) {
      const DeskewedScan scan = look(scan_number, random);
      memory.add(scan);
      if (scan_number < scans_to_stand) continue;
      const std::vector<bool> stands = rays_at_what_stands(scan, memory);
      for (std::size_t i = 0; i < stands.size(); ++i) {
        if (!ends_at_something(scan.rays[i]) || !are_asked_for(scan.rays[i])) continue;
        ++counted.hits;
        counted.standing += stands[i] ? 1 : 0;
      }
    }
  }
  return counted;
}

bool is_over_a_metre_away(const Ray& ray) {
  return range_m(ray) >= 1.1 && range_m(ray) <= 1.7;
}

/// As a robot sees it that stands in a gap of it: each ray passes close by what the one beside it hits. It
/// took parts of the row for people, a metre away, and neither drove on nor turned.
TEST(GrazedSurface, StandsThoughRaysPassCloseBy) {
  for (const double aside_m : {0.09, 0.13}) {
    const std::vector<ScanDisc> row = row_beside(aside_m);
    const auto look = [&](int scan, Random& random) { return scan_of(row, 0.1 * scan, random); };
    const Counted counted = count_standing(200, look, is_over_a_metre_away);
    EXPECT_GT(counted.standing, 0.99 * counted.hits)
        << "of " << counted.hits << ", " << aside_m << " m aside";
  }
}

TEST(GrazedSurface, StandsThoughRaysHitItNowHereNowThere) {
  for (const double aside_m : {0.05, 0.07}) {
    const std::vector<ScanDisc> row = row_beside(aside_m);
    const auto look = [&](int scan, Random& random) { return turned_scan(row, 0.1 * scan, random); };
    const Counted counted = count_standing(200, look, is_over_a_metre_away);
    EXPECT_GT(counted.standing, 0.9 * counted.hits) << "of " << counted.hits << ", " << aside_m << " m aside";
  }
}

/// Who walks out from behind the end of a wall beside the robot, across its line.
TEST(GrazedSurface, IsNotWhoWalksOutBehindItsEnd) {
  const auto look = [](int scan, Random& random) {
    std::vector<ScanDisc> discs = row_beside(0.07, 8);  // to a metre
    const Vec2 walker_m(0.5 - 0.05 * (scan - 135), 1.3);
    if (scan >= scans_to_stand) discs.push_back({walker_m, 0.15});
    return turned_scan(discs, 0.1 * scan, random);
  };
  const auto hits_them = [](const Ray& ray) { return ray.end_m.y() > 1.1; };
  const auto [hits, standing] = count_standing(150, look, hits_them);
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
