#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/bench/paper.hpp"
#include "app/commands/bench_plan.hpp"
#include "app/commands/commands.hpp"

namespace lodestar {
namespace {

// What the paper reports: Table 1, and the means of Tables 2 and 3 (mean absolute, mean 3-D distance).
constexpr int paper_correct = 192;
constexpr int paper_trials = 200;
constexpr double paper_ms = 87.0;
constexpr double paper_angle_deg = 1.64;
constexpr double paper_position_cm = 1.94;
constexpr double cm_per_m = 100.0;

struct BenchArguments {
  std::uint64_t seed = 1;
  bool json = false;
};

double percent(int part, int whole) {
  return 100.0 * part / whole;
}

nlohmann::ordered_json angle_rows(const std::vector<AngleTrial>& angles) {
  auto rows = nlohmann::ordered_json::array();
  for (const AngleTrial& trial : angles) {
    rows.push_back({{"real_deg", trial.real_deg},
                    {"output_deg", trial.output_deg},
                    {"deviation_deg", trial.deviation_deg()},
                    {"confidence", trial.confidence}});
  }
  return rows;
}

nlohmann::ordered_json position_rows(const std::vector<PositionTrial>& positions) {
  auto rows = nlohmann::ordered_json::array();
  for (const PositionTrial& trial : positions) {
    const Vec3 real = trial.real_m * cm_per_m;
    const Vec3 output = trial.output_m * cm_per_m;
    rows.push_back({{"real_cm", {real.x(), real.y(), real.z()}},
                    {"output_cm", {output.x(), output.y(), output.z()}},
                    {"distance_cm", (real - output).norm()},
                    {"confidence", trial.confidence}});
  }
  return rows;
}

void print_json(const BenchPaperOptions& options, const IdentificationResult& ids,
                const PoseBenchResult& ours, const PoseBenchResult& free) {
  const nlohmann::ordered_json report{
      {"seed", options.seed},
      {"prior", {{"tilt_sigma_deg", degrees(options.tilt_sigma_rad)}, {"height", "free"}}},
      {"table_1",
       {{"paper", {{"trials", paper_trials}, {"correct", paper_correct}, {"mean_ms", paper_ms}}},
        {"ours",
         {{"trials", ids.trials}, {"correct", ids.correct}, {"wrong", ids.wrong}, {"mean_ms", ids.mean_ms}}},
        {"identification_percent", percent(ids.correct, ids.trials)}}},
      {"table_2",
       {{"paper_mean_abs_deg", paper_angle_deg},
        {"mean_abs_deg", ours.mean_angle_deviation_deg()},
        {"mean_abs_deg_without_prior", free.mean_angle_deviation_deg()},
        {"rows", angle_rows(ours.angles)}}},
      {"table_3",
       {{"paper_mean_cm", paper_position_cm},
        {"mean_cm", cm_per_m * ours.mean_position_deviation_m()},
        {"mean_cm_without_prior", cm_per_m * free.mean_position_deviation_m()},
        {"rows", position_rows(ours.positions)}}}};
  fmt::print("{}\n", report.dump(2));
}

void print_text(const BenchPaperOptions& options, const IdentificationResult& ids,
                const PoseBenchResult& ours, const PoseBenchResult& free) {
  fmt::print(
      "Seed {}. Prior: tilt known to {:.2f} deg (a calibrated mount on a flat floor), height free.\n\n",
      options.seed, degrees(options.tilt_sigma_rad));
  fmt::print("Table 1  identification      paper       ours\n");
  fmt::print("  trials               {:>12} {:>10}\n", paper_trials, ids.trials);
  fmt::print("  correct              {:>12} {:>10}\n", paper_correct, ids.correct);
  fmt::print("  accuracy             {:>11.1f}% {:>9.1f}%\n", percent(paper_correct, paper_trials),
             percent(ids.correct, ids.trials));
  fmt::print("  mean time (ms)       {:>12.0f} {:>10.2f}\n\n", paper_ms, ids.mean_ms);

  fmt::print("Table 2  real (deg)  output (deg)  deviation (deg)  confidence\n");
  for (const AngleTrial& trial : ours.angles) {
    fmt::print("  {:>16.0f} {:>13.2f} {:>16.2f} {:>11.2f}\n", trial.real_deg, trial.output_deg,
               trial.deviation_deg(), trial.confidence);
  }
  fmt::print(
      "  mean absolute deviation: paper {:.2f} deg, ours {:.2f} deg ({:.2f} deg without any prior)\n\n",
      paper_angle_deg, ours.mean_angle_deviation_deg(), free.mean_angle_deviation_deg());

  fmt::print("Table 3  real X, Y, Z (cm)            output X, Y, Z (cm)        distance (cm)  confidence\n");
  for (const PositionTrial& trial : ours.positions) {
    const Vec3 real = trial.real_m * cm_per_m;
    const Vec3 output = trial.output_m * cm_per_m;
    fmt::print("  {:>10.2f} {:>8.2f} {:>8.2f}    {:>9.2f} {:>8.2f} {:>8.2f} {:>14.2f} {:>11.2f}\n", real.x(),
               real.y(), real.z(), output.x(), output.y(), output.z(), (real - output).norm(),
               trial.confidence);
  }
  fmt::print("  mean 3-D deviation: paper {:.2f} cm, ours {:.2f} cm ({:.2f} cm without any prior)\n",
             paper_position_cm, cm_per_m * ours.mean_position_deviation_m(),
             cm_per_m * free.mean_position_deviation_m());
}

ExitCode paper(const BenchArguments& arguments) {
  BenchPaperOptions options{.seed = arguments.seed};
  const IdentificationResult ids = bench_identification(options);
  const PoseBenchResult ours = bench_poses(options);
  BenchPaperOptions without_prior = options;
  without_prior.prior = PosePrior{};
  const PoseBenchResult free = bench_poses(without_prior);
  if (arguments.json) {
    print_json(options, ids, ours, free);
  } else {
    print_text(options, ids, ours, free);
  }
  return done;
}

}  // namespace

std::vector<Command> bench_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* bench = lodestar.add_subcommand("bench", "Measure against published figures");
  bench->require_subcommand(1);
  CLI::App* paper_command =
      bench->add_subcommand("paper", "The paper's Tables 1 to 3 beside ours, on the same trials");
  paper_command->add_option("--seed", arguments->seed, "Seed of noise, views and light")
      ->capture_default_str();
  paper_command->add_flag("--json", arguments->json, "As JSON");
  return {{paper_command, [arguments] { return paper(*arguments); }},
          bench_localize_command(*bench),
          bench_plan_command(*bench)};
}

}  // namespace lodestar
