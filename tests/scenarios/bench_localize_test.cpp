#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/bench/ceilings.hpp"
#include "app/bench/counts.hpp"
#include "app/bench/localize.hpp"

#include "tests/scenarios/command_line.hpp"

namespace lodestar {
namespace {

TEST(BenchLocalize, stays_near_the_bound_on_a_plain_ceiling) {
  const ScenePoint point = measure({.texture_gray = 0.0}, lodestar_method(), 60, 3);
  EXPECT_EQ(point.read, 60);
  EXPECT_EQ(point.upright.poses, 60);
  EXPECT_LE(point.upright.lateral_m, 0.00005);
  EXPECT_LE(degrees(point.upright.yaw_rad), 0.02);
  EXPECT_GE(point.upright.lateral_m, 0.7 * point.upright_bound.lateral_m) << "no method beats the bound";
  EXPECT_LE(point.upright.lateral_m, 2.0 * point.upright_bound.lateral_m);
}

TEST(BenchLocalize, is_repeated_by_its_seed) {
  const BenchScene scene{.noise_gray = 2.0};
  const ScenePoint first = measure(scene, lodestar_method(), 10, 8);
  const ScenePoint again = measure(scene, lodestar_method(), 10, 8);
  EXPECT_EQ(first.read, again.read);
  EXPECT_EQ(first.upright.lateral_m, again.upright.lateral_m);
  EXPECT_NE(first.upright.lateral_m, measure(scene, lodestar_method(), 10, 9).upright.lateral_m);
}

/// A rate over several ceilings of each kind: one is quick to fail by its own grooves.
TEST(BenchLocalize, reads_markers_on_every_kind_of_ceiling) {
  constexpr int frames = 75;
  constexpr double most_missed = 0.02;  // 0.5 % wanted, of some 200 markers
  constexpr double most_missed_of_touching = 0.1;
  for (const CeilingCounts& row : count_ceilings(lodestar_method(), frames, 21, [](int) {})) {
    ASSERT_GT(row.counts.markers, 100) << row.name;
    EXPECT_GE(row.counts.read,
              (1.0 - (row.dots_touch ? most_missed_of_touching : most_missed)) * row.counts.markers)
        << row.name;
    EXPECT_EQ(row.counts.wrong, 0) << row.name;
  }
}

TEST(BenchLocalize, counts_nothing_wrong_in_hard_frames) {
  for (const HardFrames kind : {HardFrames::adverse, HardFrames::empty, HardFrames::direction_dot_lost}) {
    int heard = 0;
    const FrameCounts counts =
        count_frames(kind, lodestar_method(), 60, 4, [&](int frames) { heard += frames; });
    EXPECT_EQ(counts.frames, 60);
    EXPECT_EQ(heard, 60);
    EXPECT_EQ(counts.wrong, 0) << static_cast<int>(kind);
    EXPECT_EQ(counts.markers > 0, kind == HardFrames::adverse);
  }
}

TEST(BenchLocalize, writes_a_page_and_json) {
  const ScratchFolder scratch;
  const Ran ran = run_lodestar(
      "bench localize --trials 2 --frames 10 --peers none --sweep blur --json -o out", scratch.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto report = nlohmann::json::parse(ran.out);
  EXPECT_EQ(report["methods"].size(), 1U);
  EXPECT_EQ(report["sweeps"].size(), 1U);
  EXPECT_EQ(report["sweeps"][0]["methods"]["lodestar"].size(), 7U);
  EXPECT_GE(report["targets"].size(), 10U);
  EXPECT_EQ(nlohmann::json::parse(read_text(scratch.path() / "out" / "localize.json")), report);
  const std::string page = read_text(scratch.path() / "out" / "localize.html");
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
}

TEST(BenchLocalize, refuses_a_sweep_that_it_does_not_know) {
  const ScratchFolder scratch;
  EXPECT_EQ(run_lodestar("bench localize --sweep moon", scratch.path()).exit_code, 2);
  EXPECT_EQ(run_lodestar("bench localize --peers nobody", scratch.path()).exit_code, 2);
  EXPECT_EQ(run_lodestar("bench localize --trials 0", scratch.path()).exit_code, 2);
}

}  // namespace
}  // namespace lodestar
