#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/scenarios/shots.hpp"

// `--method paper` on the command line.
namespace lodestar {
namespace {

using ::testing::HasSubstr;

class PaperMethod : public Shots {
 protected:
  Ran localize(const std::string& arguments) {
    return run("localize --method paper --markers markers.yaml --camera camera.yaml " + arguments);
  }
};

TEST_F(PaperMethod, localizes_by_three_dots_of_one_marker_without_standard_deviations) {
  const Ran ran = localize("frames");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto rows = rows_of(ran.out);
  ASSERT_EQ(rows.size(), 3U);
  ASSERT_EQ(rows[1].size(), 14U);
  EXPECT_EQ(rows[1][2], "447") << "nearest to the centre";
  // Three dots seen from straight below determine the tilt to some fifteen degrees, and so the position to
  // half a metre.
  EXPECT_NEAR(std::stod(rows[1][3]), 1.2, 0.5);
  EXPECT_NEAR(std::stod(rows[1][4]), 2.1, 0.5);
  EXPECT_NEAR(std::stod(rows[1][6]), 75.0, 2.0);
  EXPECT_GT(std::abs(std::stod(rows[1][7])) + std::abs(std::stod(rows[1][8])), 0.05)
      << "the tilt is estimated";
  EXPECT_EQ(rows[1][9] + rows[1][10] + rows[1][11], "");
  EXPECT_EQ(rows[1][13], "3");
  const Ran json = localize("--format json frames/0.5.png");
  EXPECT_TRUE(nlohmann::json::parse(json.out)["sigma_x"].is_null());
}

TEST_F(PaperMethod, gives_the_robots_place_by_eq_17) {
  const std::string robot = std::string(LODESTAR_SOURCE_DIR) + "/sites/lab/robot.yaml";
  const auto rows = rows_of(localize("--mount " + robot + " frames/0.5.png").out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(std::stod(rows[1][5]), 0.0) << "only x, y and heading";
  EXPECT_EQ(std::stod(rows[1][7]), 0.0);
  EXPECT_EQ(std::stod(rows[1][8]), 0.0);
}

TEST_F(PaperMethod, refuses_what_it_cannot_use) {
  for (const char* option : {"--upright", "--tilt-sigma-deg 0.3", "--track"}) {
    const Ran ran = localize(std::string(option) + " frames");
    EXPECT_EQ(ran.exit_code, 2) << option;
    EXPECT_THAT(ran.err, HasSubstr("--method paper"));
  }
}

TEST_F(PaperMethod, detects_with_no_probability) {
  const Ran ran = run("detect --method paper --format json frames/0.5.png");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto markers = nlohmann::json::parse(ran.out)["markers"];
  ASSERT_EQ(markers.size(), 2U);
  EXPECT_EQ(markers[0]["id"], 447);
  EXPECT_TRUE(markers[0]["probability"].is_null());
}

}  // namespace
}  // namespace lodestar
