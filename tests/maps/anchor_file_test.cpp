#include <gmock/gmock.h>

#include "maps/anchors.hpp"
#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using testing::HasSubstr;

Anchors anchors_of(const std::string& anchors) {
  const TemporaryFolder folder;
  return load_anchors(
      folder.write("anchors.yaml", "format: lodestar-anchors\nversion: 1\nanchors:\n" + anchors));
}

std::string refusal(const std::string& anchors) {
  try {
    (void)anchors_of(anchors);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(AnchorFile, has_four_kinds_of_anchors) {
  const Anchors anchors = anchors_of(
      "  - {marker: 447, x_m: 1.2, y_m: 3.4, sigma_m: 0.003, yaw_deg: 90, sigma_deg: 0.5}\n"
      "  - {robot_at_s: 12.5, log: monday, x_m: 0, y_m: 1, sigma_m: 0.01}\n"
      "  - {between: [447, 1782], distance_m: 5.25, sigma_m: 0.002}\n"
      "  - {print_scale: 1.002, sigma: 0.0001}\n");
  ASSERT_EQ(anchors.anchors.size(), 3U);
  const auto& marker = std::get<MarkerAnchor>(anchors.anchors[0].what);
  EXPECT_EQ(marker.id, 447);
  EXPECT_EQ(marker.position_m, Vec2(1.2, 3.4));
  ASSERT_TRUE(marker.yaw);
  EXPECT_NEAR(marker.yaw->yaw_rad, radians(90.0), 1e-12);
  EXPECT_EQ(anchors.anchors[0].line, 4);
  const auto& robot = std::get<RobotAnchor>(anchors.anchors[1].what);
  EXPECT_EQ(robot.log, "monday");
  EXPECT_FALSE(robot.yaw);
  EXPECT_EQ(std::get<DistanceAnchor>(anchors.anchors[2].what).second, 1782);
  EXPECT_EQ(anchors.print_scale.scale, 1.002);
  EXPECT_EQ(anchors.print_scale.sigma, 0.0001);
}

TEST(AnchorFile, an_unmeasured_print_is_known_to_a_fifth_of_a_percent) {
  EXPECT_EQ(anchors_of("  []\n").print_scale.sigma, 0.002);
}

TEST(AnchorFile, refuses_with_line_what_it_does_not_know) {
  EXPECT_THAT(refusal("  - {marker: 447, x_m: 1, y_m: 3, sigma_m: 0}\n"), HasSubstr(":4: found"));
  EXPECT_THAT(refusal("  - {marker: 4470, x_m: 1, y_m: 3, sigma_m: 0.1}\n"), HasSubstr("4470"));
  EXPECT_THAT(refusal("  - {marker: 447, x_m: 1, y_m: .nan, sigma_m: 0.1}\n"), HasSubstr("y_m"));
  EXPECT_THAT(refusal("  - {marker: 447, x_m: 1, y_m: 3, sigma_m: 0.1, yaw_deg: 3}\n"),
              HasSubstr("sigma_deg"));
  EXPECT_THAT(refusal("  - {between: [447, 447], distance_m: 1, sigma_m: 0.1}\n"),
              HasSubstr("two different"));
  EXPECT_THAT(refusal("  - {between: [447, 1.5], distance_m: 1, sigma_m: 0.1}\n"), HasSubstr("1.5"));
  EXPECT_THAT(refusal("  - {wall: 3}\n"), HasSubstr("no known kind"));
  EXPECT_THAT(refusal("  - {print_scale: 1, sigma: 0.1}\n  - {print_scale: 1, sigma: 0.1}\n"),
              HasSubstr(":5: found print_scale again"));
}

}  // namespace
}  // namespace lodestar
