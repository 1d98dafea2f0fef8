#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/bench/paper.hpp"
#include "app/commands/bench_all.hpp"
#include "app/commands/bench_plan.hpp"
#include "app/commands/commands.hpp"
#include "app/common/json_text.hpp"

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

/// One method's figures in all three tables.
struct MethodFigures {
  IdentificationResult ids;
  PoseBenchResult poses;
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

nlohmann::ordered_json identification(const IdentificationResult& ids) {
  return {{"trials", ids.trials}, {"correct", ids.correct}, {"wrong", ids.wrong}, {"mean_ms", ids.mean_ms}};
}

void print_json(const BenchPaperOptions& options, const MethodFigures& ours, const PoseBenchResult& free,
                const MethodFigures& method) {
  const nlohmann::ordered_json report{
      {"seed", options.seed},
      {"prior", {{"tilt_sigma_deg", degrees(options.tilt_sigma_rad)}, {"height", "free"}}},
      {"table_1",
       {{"paper", {{"trials", paper_trials}, {"correct", paper_correct}, {"mean_ms", paper_ms}}},
        {"ours", identification(ours.ids)},
        {"identification_percent", percent(ours.ids.correct, ours.ids.trials)},
        {"papers_method", identification(method.ids)}}},
      {"table_2",
       {{"paper_mean_abs_deg", paper_angle_deg},
        {"mean_abs_deg", ours.poses.mean_angle_deviation_deg()},
        {"mean_abs_deg_without_prior", free.mean_angle_deviation_deg()},
        {"rows", angle_rows(ours.poses.angles)},
        {"mean_abs_deg_by_papers_method", method.poses.mean_angle_deviation_deg()},
        {"rows_by_papers_method", angle_rows(method.poses.angles)}}},
      {"table_3",
       {{"paper_mean_cm", paper_position_cm},
        {"mean_cm", cm_per_m * ours.poses.mean_position_deviation_m()},
        {"mean_cm_without_prior", cm_per_m * free.mean_position_deviation_m()},
        {"rows", position_rows(ours.poses.positions)},
        {"mean_cm_by_papers_method", cm_per_m * method.poses.mean_position_deviation_m()},
        {"rows_by_papers_method", position_rows(method.poses.positions)}}}};
  fmt::print("{}", json_document(report));
}

void print_table_1(const IdentificationResult& ours, const IdentificationResult& method) {
  fmt::print("Table 1  identification      paper       ours  paper's method here\n");
  fmt::print("  trials               {:>12} {:>10} {:>20}\n", paper_trials, ours.trials, method.trials);
  fmt::print("  correct              {:>12} {:>10} {:>20}\n", paper_correct, ours.correct, method.correct);
  fmt::print("  accuracy             {:>11.1f}% {:>9.1f}% {:>19.1f}%\n", percent(paper_correct, paper_trials),
             percent(ours.correct, ours.trials), percent(method.correct, method.trials));
  fmt::print("  wrong IDs            {:>12} {:>10} {:>20}\n", "not said", ours.wrong, method.wrong);
  fmt::print("  mean time (ms)       {:>12.0f} {:>10.2f} {:>20.2f}\n\n", paper_ms, ours.mean_ms,
             method.mean_ms);
}

void print_table_2(const PoseBenchResult& ours, const PoseBenchResult& free, const PoseBenchResult& method) {
  fmt::print(
      "Table 2  real (deg)  output (deg)  deviation (deg)  confidence  deviation by the paper's method\n");
  for (std::size_t i = 0; i < ours.angles.size(); ++i) {
    const AngleTrial& trial = ours.angles[i];
    fmt::print("  {:>16.0f} {:>13.2f} {:>16.2f} {:>11.2f} {:>32.2f}\n", trial.real_deg, trial.output_deg,
               trial.deviation_deg(), trial.confidence, method.angles[i].deviation_deg());
  }
  fmt::print(
      "  mean absolute deviation: paper {:.2f} deg, ours {:.2f} deg ({:.2f} deg without any prior), "
      "the paper's method here {:.2f} deg\n\n",
      paper_angle_deg, ours.mean_angle_deviation_deg(), free.mean_angle_deviation_deg(),
      method.mean_angle_deviation_deg());
}

void print_table_3(const PoseBenchResult& ours, const PoseBenchResult& free, const PoseBenchResult& method) {
  fmt::print(
      "Table 3  real X, Y, Z (cm)            output X, Y, Z (cm)        distance (cm)  confidence  "
      "distance by the paper's method\n");
  for (std::size_t i = 0; i < ours.positions.size(); ++i) {
    const PositionTrial& trial = ours.positions[i];
    const Vec3 real = trial.real_m * cm_per_m;
    const Vec3 output = trial.output_m * cm_per_m;
    fmt::print("  {:>10.2f} {:>8.2f} {:>8.2f}    {:>9.2f} {:>8.2f} {:>8.2f} {:>14.2f} {:>11.2f} {:>31.2f}\n",
               real.x(), real.y(), real.z(), output.x(), output.y(), output.z(), (real - output).norm(),
               trial.confidence, cm_per_m * method.positions[i].distance_m());
  }
  fmt::print(
      "  mean 3-D deviation: paper {:.2f} cm, ours {:.2f} cm ({:.2f} cm without any prior), "
      "the paper's method here {:.2f} cm\n",
      paper_position_cm, cm_per_m * ours.mean_position_deviation_m(),
      cm_per_m * free.mean_position_deviation_m(), cm_per_m * method.mean_position_deviation_m());
}

void print_text(const BenchPaperOptions& options, const MethodFigures& ours, const PoseBenchResult& free,
                const MethodFigures& method) {
  fmt::print(
      "Seed {}. Prior: tilt known to {:.2f} deg (a calibrated mount on a flat floor), height free.\n\n",
      options.seed, degrees(options.tilt_sigma_rad));
  print_table_1(ours.ids, method.ids);
  print_table_2(ours.poses, free, method.poses);
  print_table_3(ours.poses, free, method.poses);
}

MethodFigures figures_of(BenchPaperOptions options, MeasuredBy method) {
  options.method = method;
  return {bench_identification(options), bench_poses(options)};
}

ExitCode paper(const BenchArguments& arguments) {
  const BenchPaperOptions options{.seed = arguments.seed};
  const MethodFigures ours = figures_of(options, MeasuredBy::lodestar);
  const MethodFigures method = figures_of(options, MeasuredBy::paper);
  BenchPaperOptions without_prior = options;
  without_prior.prior = PosePrior{};
  const PoseBenchResult free = bench_poses(without_prior);
  if (arguments.json) {
    print_json(options, ours, free, method);
  } else {
    print_text(options, ours, free, method);
  }
  return done;
}

}  // namespace

std::vector<Command> bench_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* bench = lodestar.add_subcommand("bench", "Measure against published figures");
  bench->require_subcommand(1);
  CLI::App* paper_command = bench->add_subcommand(
      "paper", "The paper's Tables 1 to 3 beside ours, and beside the paper's method on the same frames");
  paper_command->add_option("--seed", arguments->seed, "Seed of noise, views and light")
      ->capture_default_str();
  paper_command->add_flag("--json", arguments->json, "As JSON");
  return {{paper_command, [arguments] { return paper(*arguments); }},
          bench_localize_command(*bench),
          bench_survey_command(*bench),
          bench_plan_command(*bench),
          bench_all_command(*bench)};
}

}  // namespace lodestar
