#include "localization/survey/ceiling_track.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace lodestar {
namespace {

Stamp at(int tenths) {
  return Stamp(std::chrono::milliseconds(100 * tenths));
}

/// A curve with a frame every tenth of a second; every fifth is a keyframe.
class CeilingTrackTest : public testing::Test {
 protected:
  static constexpr int frames = 23;
  static Pose2 pose(int frame) {
    const double t = 0.1 * frame;
    return {{0.4 * t, 0.1 * t * t}, 0.3 * t};
  }

  CeilingTrackTest() {
    int keyframe = 0;
    for (int frame = 1; frame < frames; ++frame) {
      VisualOdometryIncrement motion{.from = at(keyframe),
                                     .to = at(frame),
                                     .then_from_now = inverse(pose(keyframe)) * pose(frame),
                                     .sway_m = 0.004};
      motion.covariance.diagonal() << 1e-6, 1e-6, 1e-7;
      increments.push_back(motion);
      if (frame % 5 == 0) keyframe = frame;
    }
  }

  void expect_way(int from, int to) const {
    const auto segment = CeilingTrack(increments).between(at(from), at(to));
    ASSERT_TRUE(segment) << from << " to " << to;
    const Pose2 way = inverse(pose(from)) * pose(to);
    EXPECT_LT((segment->motion.position_m - way.position_m).norm(), 1e-12) << from << " to " << to;
    EXPECT_NEAR(segment->motion.yaw_rad, way.yaw_rad, 1e-12);
  }

  std::vector<VisualOdometryIncrement> increments;
};

TEST_F(CeilingTrackTest, joins_increments_across_keyframes) {
  for (const auto& [from, to] : {std::pair(1, 3), {0, 4}, {3, 5}, {5, 6}, {2, 17}, {5, 10}, {7, 22}})
    expect_way(from, to);
}

TEST_F(CeilingTrackTest, grows_less_certain_with_each_keyframe) {
  const CeilingTrack track(increments);
  const auto sigma = [&](int from, int to) { return track.between(at(from), at(to))->covariance(1, 1); };
  EXPECT_GT(sigma(1, 22), sigma(1, 12));
  EXPECT_GT(sigma(1, 12), sigma(1, 3));
  EXPECT_GT(sigma(1, 3), 1e-6) << "the first frame was seen with an error, too";
}

TEST_F(CeilingTrackTest, says_nothing_where_the_ceiling_was_lost) {
  std::erase_if(increments, [](const VisualOdometryIncrement& motion) { return motion.to == at(10); });
  const CeilingTrack track(increments);
  EXPECT_TRUE(track.between(at(1), at(9)));
  EXPECT_FALSE(track.between(at(1), at(12))) << "the second keyframe was never seen from the first";
  EXPECT_FALSE(track.between(at(3), at(10))) << "nor does the frame itself count";
  EXPECT_TRUE(track.between(at(11), at(22)));
}

}  // namespace
}  // namespace lodestar
