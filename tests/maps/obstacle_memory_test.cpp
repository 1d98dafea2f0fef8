#include "maps/obstacle_memory.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <vector>

#include "maps/random.hpp"
#include "maps/standing_rays.hpp"

#include "tests/maps/disc_scan.hpp"

namespace lodestar {
namespace {

using Disc = testing::ScanDisc;
using testing::scan_of;

double share_standing(const ObstacleMemory& memory, const DeskewedScan& scan) {
  const std::vector<bool> stands = rays_at_what_stands(scan, memory);
  const auto hits = std::ranges::count_if(scan.rays, ends_at_something);
  return static_cast<double>(std::ranges::count(stands, true)) / static_cast<double>(hits);
}

TEST(ObstacleMemory, ABoxStandsAfterASecond) {
  Random random(1);
  ObstacleMemory memory;
  const Disc box{{2.0, 0.5}, 0.3};
  for (int scans = 0; scans < 20; ++scans) {
    const DeskewedScan scan = scan_of({box}, 0.1 * scans, random);
    memory.add(scan);
    if (scans < 10) {
      EXPECT_EQ(share_standing(memory, scan), 0.0) << scans;
    } else if (scans >= 13) {
      EXPECT_GT(share_standing(memory, scan), 0.97) << scans;
    }
    EXPECT_FALSE(memory.has_come({1.71, 0.43})) << scans;
  }
}

TEST(ObstacleMemory, WhatIsSeenFreeIsGoneAfterTwoScans) {
  Random random(2);
  ObstacleMemory memory;
  for (int scans = 0; scans < 30; ++scans) memory.add(scan_of({Disc{{2.0, 0.5}, 0.3}}, 0.1 * scans, random));
  EXPECT_GT(memory.occupied_m(Stamp(from_seconds(2.9))).size(), 5U);
  memory.add(scan_of({}, 3.0, random));
  memory.add(scan_of({}, 3.1, random));
  EXPECT_TRUE(memory.occupied_m(Stamp(from_seconds(3.1))).empty());
  EXPECT_FALSE(memory.stands_at({1.71, 0.43}, Stamp(from_seconds(3.1))));
}

/// Of 0.5 m radius, across the view: in both directions, also turning back.
TEST(ObstacleMemory, AMovingDiscNeverStandsAndLeavesNoTrail) {
  for (const double speed_mps : {0.5, 0.7, 1.2, 2.0}) {
    Random random(3);
    ObstacleMemory memory;
    for (int scans = 0; scans < 80; ++scans) {
      const double way = std::fmod(speed_mps * 0.1 * scans, 4.0);
      const Disc disc{{2.0, way < 2.0 ? way - 1.0 : 3.0 - way}, 0.5};
      const DeskewedScan scan = scan_of({disc}, 0.1 * scans, random);
      memory.add(scan);
      EXPECT_EQ(share_standing(memory, scan), 0.0) << speed_mps << " m/s, scan " << scans;
      for (const Vec2& cell_m : memory.occupied_m(scan.newest)) {
        // In two scans the disc moves on by 0.2 s.
        EXPECT_LT((cell_m - disc.center_m).norm(), 0.5 + 0.2 * speed_mps + 0.1);
      }
    }
  }
}

/// Walks for two seconds, stops, and stands: at first to walk on, then like a thing.
TEST(ObstacleMemory, SomeoneWhoHasStoppedStandsOnlyAfterTenSeconds) {
  for (const double speed_mps : {0.5, 1.5}) {
    Random random(5);
    ObstacleMemory memory;
    for (int scans = 0; scans < 140; ++scans) {
      const Disc disc{{2.0, speed_mps * (std::min(0.1 * scans, 2.0) - 1.0)}, 0.25};
      const DeskewedScan scan = scan_of({disc}, 0.1 * scans, random);
      memory.add(scan);
      if (scans < 115) {
        EXPECT_EQ(share_standing(memory, scan), 0.0) << speed_mps << " m/s, scan " << scans;
      } else if (scans >= 130) {
        EXPECT_GT(share_standing(memory, scan), 0.9) << speed_mps << " m/s, scan " << scans;
        EXPECT_TRUE(memory.has_come(disc.center_m * (1.0 - 0.25 / disc.center_m.norm()))) << scans;
      }
    }
  }
}

/// What comes out from behind the end of a wall is seen first where nothing was known to be free.
TEST(ObstacleMemory, WhatComesIntoSightOfAThingThatStandsHasNotCome) {
  Random random(6);
  ObstacleMemory memory;
  for (int scans = 0; scans < 40; ++scans) {
    DeskewedScan scan = scan_of({Disc{{2.0, 0.5}, 0.3}}, 0.1 * scans, random);
    const double covered_until_rad = 0.24 - 0.004 * scans;  // the edge of a pane that slides away
    for (Ray& ray : scan.rays)
      if (const double turn = std::atan2(ray.end_m.y(), ray.end_m.x());
          turn > -0.3 && turn < covered_until_rad)
        ray = {ray.stamp, ray.origin_m, ray.end_m.normalized(), Echo::hit};
    memory.add(scan);
    if (scans < 35) continue;
    for (std::size_t i = 0; i < scan.rays.size(); ++i) {
      if (scan.rays[i].end_m.norm() > 1.5 && ends_at_something(scan.rays[i])) {
        EXPECT_TRUE(rays_at_what_stands(scan, memory)[i]) << scans << ", " << scan.rays[i].end_m.transpose();
      }
    }
  }
}

/// A post that stands ahead; in so many of twenty scans `spoil` changes what is seen of it. Nobody has
/// come there. Eight scans are longer than two looks back take, three are shorter.
template <typename Spoil>
void expect_not_come(double radius_m, int spoilt_scans, const Spoil& spoil, double range_m = 3.0) {
  Random random(7);
  const Disc post{{range_m, 0.0}, radius_m};
  ObstacleMemory memory;
  for (int scans = 0; scans < 100; ++scans) {
    DeskewedScan scan = scan_of({post}, 0.1 * scans, random);
    if (scans % 20 >= 4 && scans % 20 < 4 + spoilt_scans) spoil(scan);
    memory.add(scan);
    EXPECT_FALSE(memory.has_come({range_m - radius_m, 0.0})) << scans;
  }
}

/// Two or three beams meet a thin post: where spots fall on its edges, they are lost. Taken for someone who
/// has come, it held the robot for ten minutes.
TEST(ObstacleMemory, APostWhoseBeamsAreLostHasNotCome) {
  expect_not_come(0.05, 8, [](DeskewedScan& scan) {
    for (Ray& ray : scan.rays)
      if (ray.echo == Echo::hit) ray = {ray.stamp, ray.origin_m, ray.end_m.normalized(), Echo::invalid};
  });
}

/// Half of each spot falls on the post and half on what is behind: the scanner reports a range between.
TEST(ObstacleMemory, APostWhoseBeamsAreAllMixedPixelsForALookHasNotCome) {
  expect_not_come(0.05, 3, [](DeskewedScan& scan) {
    for (Ray& ray : scan.rays)
      if (ray.echo == Echo::hit) ray.end_m *= 1.3;
  });
}

/// Farther away fewer beams meet it, and all of them fall beside it for longer.
TEST(ObstacleMemory, APostSixMetresAwayThatIsMissedForThreeLooksHasNotCome) {
  constexpr double range_m = 6.0;
  const auto look_past = [](DeskewedScan& scan) {
    for (Ray& ray : scan.rays)
      if (ray.echo == Echo::hit)
        ray = {ray.stamp, ray.origin_m, testing::max_range_m * ray.end_m.normalized(), Echo::nothing};
  };
  expect_not_come(0.05, 8, look_past, range_m);
}

/// Hit in one or another of the four by the noise of the range, it never stood, and held the robot for good.
TEST(ObstacleMemory, AThinPostWhereFourCellsMeetStandsAfterTenSecondsAsLegsDo) {
  Random random(9);
  const Vec2 corner_m(1.5, 1.0);      // of four cells: its near side is there
  constexpr double radius_m = 0.055;  // thick enough to hide a leg behind it
  const Disc post{corner_m + radius_m * corner_m.normalized(), radius_m};
  ObstacleMemory memory;
  for (int scans = 0; scans < 200; ++scans) {
    const DeskewedScan scan = scan_of({post}, 0.1 * scans, random);
    memory.add(scan);
    if (scans < 95) {
      EXPECT_EQ(share_standing(memory, scan), 0.0) << scans;
    } else if (scans > 130) {
      EXPECT_GT(share_standing(memory, scan), 0.9) << scans;
    }
  }
}

/// A leg that is shoved along by a few centimetres a second is not one that stands.
TEST(ObstacleMemory, AThinThingThatCreepsNeverStands) {
  Random random(10);
  ObstacleMemory memory;
  for (int scans = 0; scans < 300; ++scans) {
    const DeskewedScan scan = scan_of({{{1.5, -1.0 + 0.005 * scans}, 0.03}}, 0.1 * scans, random);
    memory.add(scan);
    EXPECT_EQ(share_standing(memory, scan), 0.0) << scans;
  }
}

/// While it turns against its scanner, a robot sees less than a full turn in a scan. What lies in the gap was
/// not seen free, though the beams beside it pass.
TEST(ObstacleMemory, WhatLiesInTheSeamOfATurnHasNotCome) {
  expect_not_come(0.1, 8, [](DeskewedScan& scan) {
    std::erase_if(scan.rays, [](const Ray& ray) { return std::abs(heading_of(ray.end_m)) < radians(2.5); });
  });
}

/// A sliding door that has stood open, 1.2 m ahead: what it covers of the floor has come. Its edge may move
/// on by the 15 cm that scans do not tell apart, and by a scan.
TEST(ObstacleMemory, AThingThatStoodAndSlidesOnHasComeWhereTheFloorWasFree) {
  constexpr double slides_mps = 0.5;
  int late = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    ObstacleMemory memory;
    for (int scans = 0; scans < 38; ++scans) {
      const double edge_m = slides_mps * std::max(0.0, 0.1 * (scans - 30.0)) - 0.3;
      std::vector<Disc> leaf;
      for (int disc = 0; disc < 15; ++disc)
        leaf.push_back({{1.2, edge_m - 0.04 - 0.07 * static_cast<double>(disc)}, 0.04});
      const DeskewedScan scan = scan_of(leaf, 0.1 * scans, random);
      memory.add(scan);
      const std::vector<bool> stands = rays_at_what_stands(scan, memory);
      std::optional<std::size_t> edge;
      for (std::size_t i = 0; i < scan.rays.size(); ++i)
        if (ends_at_something(scan.rays[i]) && (!edge || scan.rays[i].end_m.y() > scan.rays[*edge].end_m.y()))
          edge = i;
      ASSERT_TRUE(edge);
      if (scans == 29) {
        EXPECT_TRUE(stands[*edge]);
      }
      if (scans >= 35 && stands[*edge]) ++late;  // 25 cm
    }
  }
  EXPECT_LE(late, 1) << "of 60 scans";
}

/// A post before another one is a thing. Where the robot has come so near that someone's body would touch it,
/// it stays one, though it looks like a leg from there.
TEST(ObstacleMemory, WhatLooksLikeALegOnlyFromCloseByIsNone) {
  for (const bool is_near : {true, false}) {
    Random random(11);
    ObstacleMemory memory;
    const double at_m = is_near ? 0.5 : 0.8;
    const Disc post{{at_m, 0.0}, 0.06};
    for (int scans = 0; scans < 20; ++scans)
      memory.add(scan_of({post, {{at_m + 0.14, 0.14}, 0.1}}, 0.1 * scans, random));
    for (int scans = 20; scans < 60; ++scans) memory.add(scan_of({post}, 0.1 * scans, random));
    EXPECT_EQ(memory.has_legs({at_m - 0.06, 0.0}), !is_near);
  }
}

/// Someone walks along a box so closely that their legs are hit where it is hit, too.
TEST(ObstacleMemory, ABoxIsNoLegForLongerThanTenSecondsAfterOneWasBesideIt) {
  Random random(8);
  ObstacleMemory memory;
  const Disc box{{2.0, 0.0}, 0.2};
  const auto has_legs = [&](int scans, const std::vector<Disc>& discs) {
    const DeskewedScan scan = scan_of(discs, 0.1 * scans, random);
    memory.add(scan);
    return std::ranges::any_of(
        scan.rays, [&](const Ray& ray) { return ends_at_something(ray) && memory.has_legs(ray.end_m); });
  };
  for (int scans = 0; scans < 30; ++scans) EXPECT_FALSE(has_legs(scans, {box})) << scans;
  for (int scans = 30; scans < 50; ++scans) {
    const double y_m = 0.06 * (scans - 40.0);
    has_legs(scans, {box, {{1.74, y_m + 0.1}, 0.06}, {{1.74, y_m - 0.1}, 0.06}});
  }
  EXPECT_TRUE(has_legs(50, {box}));
  for (int scans = 51; scans < 200; ++scans) {
    const bool has = has_legs(scans, {box});
    if (scans > 152) {
      EXPECT_FALSE(has) << scans;
    }
  }
}

/// Who stands shows legs all the time, one behind the other too.
TEST(ObstacleMemory, LegsThatStandStayLegs) {
  for (const bool abreast : {true, false}) {
    Random random(9);
    ObstacleMemory memory;
    const std::vector<Disc> legs = abreast ? std::vector<Disc>{{{1.5, 0.1}, 0.06}, {{1.5, -0.1}, 0.06}}
                                           : std::vector<Disc>{{{1.5, 0.0}, 0.06}, {{1.7, 0.02}, 0.06}};
    for (int scans = 0; scans < 600; ++scans) {
      const DeskewedScan scan = scan_of(legs, 0.1 * scans, random);
      memory.add(scan);
      if (scans < 200) continue;
      const bool are_legs = std::ranges::all_of(scan.rays, [&](const Ray& ray) {
        const bool is_near_leg = ends_at_something(ray) && ray.end_m.norm() < 1.55;
        return !is_near_leg || memory.has_legs(ray.end_m);
      });
      EXPECT_TRUE(are_legs) << abreast << " " << scans;
    }
  }
}

/// From farther away than legs can be told, what was one stays one while it is hit.
TEST(ObstacleMemory, ALegStaysOneSeenFromFarAway) {
  Random random(21);
  ObstacleMemory memory;
  const auto look_from = [&](double scanner_x_m, double at_s) {
    const Vec2 scanner_m(scanner_x_m, 0.0);
    DeskewedScan scan = scan_of({{Vec2(6.0, 0.0) - scanner_m, 0.06}}, at_s, random);
    for (Ray& ray : scan.rays) {
      ray.origin_m += scanner_m;
      ray.end_m += scanner_m;
    }
    memory.add(scan);
  };
  for (int scans = 0; scans < 130; ++scans) look_from(4.0, 0.1 * scans);
  ASSERT_TRUE(memory.has_legs({5.94, 0.0}));
  for (int scans = 130; scans < 600; ++scans) {  // cells that are not hit any more are forgotten
    look_from(1.0, 0.1 * scans);
    ASSERT_TRUE(memory.has_legs({5.94, 0.0})) << scans;
  }
}

/// A point in front of it narrows a gap: cells there are hit by the noise of the range alone.
TEST(ObstacleMemory, WhatStandsIsWhereItsSurfaceIs) {
  for (const double post_m : {0.075, 0.2}) {
    int points = 0;
    int in_front = 0;
    for (int seed = 0; seed < 20; ++seed) {
      Random random(100 + seed);
      const Vec2 middle_m(1.0, 0.3 + 0.003 * seed);
      ObstacleMemory memory;
      for (int scans = 0; scans < 300; ++scans)
        memory.add(scan_of({Disc{middle_m, post_m}}, 0.1 * scans, random));
      for (const Vec2& point_m : memory.standing_m(Stamp(from_seconds(29.9)))) {
        ++points;
        if ((point_m - middle_m).norm() > post_m + 0.015) ++in_front;
      }
    }
    EXPECT_GE(points, 40);
    EXPECT_LE(in_front, 0.02 * points) << post_m;
  }
}

TEST(ObstacleMemory, OutOfSightWhatMovedIsForgottenBeforeWhatStood) {
  Random random(4);
  ObstacleMemory memory;
  memory.add(scan_of({Disc{{2.0, 0.0}, 0.3}}, 0.0, random));
  EXPECT_FALSE(memory.occupied_m(Stamp(from_seconds(1.4))).empty());
  EXPECT_TRUE(memory.occupied_m(Stamp(from_seconds(1.6))).empty());
  for (int scans = 20; scans < 50; ++scans) memory.add(scan_of({Disc{{2.0, 0.0}, 0.3}}, 0.1 * scans, random));
  EXPECT_TRUE(memory.stands_at({1.7, 0.0}, Stamp(from_seconds(34.0))));
  EXPECT_FALSE(memory.stands_at({1.7, 0.0}, Stamp(from_seconds(35.0))));
}

}  // namespace
}  // namespace lodestar
