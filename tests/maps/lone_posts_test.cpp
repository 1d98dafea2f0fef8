#include "maps/lone_posts.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

#include "maps/legs.hpp"
#include "maps/obstacle_memory.hpp"

#include "tests/maps/disc_scan.hpp"

namespace lodestar {
namespace {

using Disc = testing::ScanDisc;

/// From elsewhere than the origin.
DeskewedScan scan_from(const Vec2& place_m, std::vector<Disc> discs, double at_s, Random& random) {
  for (Disc& disc : discs) disc.center_m -= place_m;
  DeskewedScan scan = testing::scan_of(discs, at_s, random);
  for (Ray& ray : scan.rays) {
    ray.origin_m += place_m;
    ray.end_m += place_m;
  }
  return scan;
}

Vec2 on_circle(double radius_m, double degrees) {
  return {radius_m * std::cos(radians(degrees)), radius_m * std::sin(radians(degrees))};
}

/// The robot drives around the origin, ten degrees a second.
class Round {
 public:
  Round(std::vector<Disc> discs, double radius_m, std::uint64_t seed)
      : discs_(std::move(discs)), radius_m_(radius_m), random_(seed) {}

  void put(const Disc& disc) { discs_.push_back(disc); }

  /// How many scans of the arc showed a post.
  int posts_on(double from_deg, double to_deg) {
    int scans = 0;
    for (double degrees = from_deg; degrees < to_deg; degrees += 1.0)
      if (!look(on_circle(radius_m_, degrees)).empty()) ++scans;
    return scans;
  }

  int posts_from(double degrees, int scans) {
    int with_posts = 0;
    for (int i = 0; i < scans; ++i)
      if (!look(on_circle(radius_m_, degrees)).empty()) ++with_posts;
    return with_posts;
  }

  const ObstacleMemory& memory() const { return memory_; }

 private:
  std::vector<LonePost> look(const Vec2& from_m) {
    const DeskewedScan scan = scan_from(from_m, discs_, 0.1 * ++scans_, random_);
    memory_.add(scan);
    return posts_.add(scan, RayFan(scan), rays_at_legs(scan).likely);
  }

  std::vector<Disc> discs_;
  double radius_m_;
  Random random_;
  LonePosts posts_;
  ObstacleMemory memory_;
  int scans_ = 0;
};

TEST(LonePosts, AreKnownOnceTheRobotHasSeenBehindThem) {
  int seeds_known = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Round round({Disc{{0.0, 0.0}, 0.05 + 0.002 * static_cast<double>(seed)}}, 1.0, seed);
    EXPECT_EQ(round.posts_from(0.0, 50), 0) << seed;
    EXPECT_TRUE(round.memory().has_legs({0.06, 0.0})) << seed;
    (void)round.posts_on(0.0, 90.0);
    if (round.posts_from(90.0, 20) >= 8) ++seeds_known;  // not each scan shows so thick a thing as a leg
  }
  EXPECT_GE(seeds_known, 19) << "of 20";
}

/// The legs of a chair or of someone who stands: from all around, so that each hides the other twice.
TEST(LonePosts, AreNoLegs) {
  int scans = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const double half_m = 0.08 + 0.00125 * static_cast<double>(seed);  // 16 to 26 cm from middle to middle
    const double radius_m = 0.045 + 0.005 * static_cast<double>(seed % 4);
    const double range_m = 0.6 + 0.05 * static_cast<double>(seed % 20);
    Round round({Disc{{half_m, 0.0}, radius_m}, Disc{{-half_m, 0.0}, radius_m}}, range_m, seed);
    scans += round.posts_on(0.3 * static_cast<double>(seed), 720.0);
    EXPECT_TRUE(round.memory().has_legs({half_m + radius_m, 0.0})) << seed;
    EXPECT_TRUE(round.memory().standing_posts_m(Stamp(from_seconds(72.0))).empty()) << seed;
  }
  EXPECT_EQ(scans, 0);
}

TEST(LonePosts, AreNoMoreWhenALegIsSeenBeside) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Round round({Disc{{0.0, 0.0}, 0.06}}, 1.0, seed);
    (void)round.posts_on(0.0, 60.0);
    EXPECT_GT(round.posts_from(60.0, 20), 0) << seed;
    round.put({on_circle(0.2, 150.0), 0.06});
    (void)round.posts_from(60.0, 3);
    EXPECT_EQ(round.posts_from(60.0, 20), 0) << seed;
  }
}

/// It is a thing then, which stands after a second.
TEST(LonePosts, AreNotRememberedAsLegs) {
  int things = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Round round({Disc{{0.0, 0.0}, 0.06}}, 1.0, seed);
    (void)round.posts_on(0.0, 90.0);
    const Stamp now(from_seconds(9.0));
    const bool is_post = !round.memory().standing_posts_m(now).empty();
    if (is_post && !round.memory().has_legs(on_circle(0.06, 89.0))) ++things;
    EXPECT_TRUE(round.memory().stands_at(on_circle(0.06, 89.0), now)) << seed;
  }
  EXPECT_GE(things, 19) << "of 20";
}

}  // namespace
}  // namespace lodestar
