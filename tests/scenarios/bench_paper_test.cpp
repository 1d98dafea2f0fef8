#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/bench/paper.hpp"

#include "tests/scenarios/command_line.hpp"

namespace lodestar {
namespace {

TEST(BenchPaper, identifies_at_least_99_percent_and_nothing_wrongly) {
  const IdentificationResult result = bench_identification({.seed = 3});
  EXPECT_EQ(result.trials, 200);
  EXPECT_GE(result.correct, 198);
  EXPECT_EQ(result.wrong, 0);
}

TEST(BenchPaper, measures_within_half_a_degree_and_a_centimetre) {
  const PoseBenchResult result = bench_poses({.seed = 3});
  EXPECT_EQ(result.angles.size(), 13U);
  EXPECT_LE(result.mean_angle_deviation_deg(), 0.5);
  EXPECT_EQ(result.positions.size(), 11U);
  EXPECT_LE(result.mean_position_deviation_m(), 0.010);
}

TEST(BenchPaper, gives_confidences_like_the_papers) {
  const PoseBenchResult result = bench_poses({.seed = 1});
  for (const PositionTrial& trial : result.positions) {
    EXPECT_GE(trial.confidence, 0.80);
    EXPECT_LE(trial.confidence, 0.97);
  }
}

TEST(BenchPaper, prints_json) {
  const ScratchFolder scratch;
  const Ran ran = run_lodestar("bench paper --json", scratch.path());
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const auto report = nlohmann::json::parse(ran.out);
  EXPECT_EQ(report["table_2"]["rows"].size(), 13U);
  EXPECT_EQ(report["table_3"]["rows"].size(), 11U);
}

}  // namespace
}  // namespace lodestar
