#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <memory>

#include "app/bench/localize_report.hpp"
#include "app/commands/commands.hpp"
#include "app/common/json_text.hpp"
#include "app/common/progress.hpp"
#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct BenchLocalizeArguments {
  BenchLocalizeOptions options;
  std::vector<std::string> sweeps{"all"};
  bool json = false;
  bool quiet = false;
  std::string folder;
};

std::vector<std::string> sweeps_of(const std::vector<std::string>& asked) {
  if (std::ranges::find(asked, "all") != asked.end()) return sweep_names();
  if (asked.size() == 1 && asked.front() == "none") return {};
  return asked;
}

ExitCode run(const BenchLocalizeArguments& arguments) {
  BenchLocalizeOptions options = arguments.options;
  options.sweeps = sweeps_of(arguments.sweeps);
  std::erase(options.peers, "none");
  const fs::path folder = arguments.folder;
  if (!folder.empty()) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throw InputError(folder, 0, "no folder that can be made", "a folder to write to");
  }
  Progress progress("bench", arguments.quiet);
  const BenchLocalizeResult result =
      bench_localize(options, [&progress](double share) { progress.show(share); });
  for (const std::string& peer : result.left_out)
    fmt::print(stderr, "bench: {} is skipped, this program was built without it\n", peer);
  const std::string json = json_document(bench_localize_json(result));
  if (!folder.empty()) {
    write_file_atomically(folder / "localize.json", json);
    write_file_atomically(folder / "localize.html", bench_localize_html(result));
    if (!arguments.quiet) fmt::print(stderr, "bench: wrote {}\n", (folder / "localize.html").string());
  }
  fmt::print("{}", arguments.json ? json : bench_localize_text(result));
  return done;
}

}  // namespace

Command bench_localize_command(CLI::App& bench) {
  const auto arguments = std::make_shared<BenchLocalizeArguments>();
  arguments->options.peers = {"apriltag", "aruco"};
  CLI::App* command = bench.add_subcommand(
      "localize",
      "Rendered frames through us, AprilTag and ArUco: time, identification, error over the bound");
  BenchLocalizeOptions& options = arguments->options;
  command->add_option("--trials", options.trials, "Frames at each point")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--frames", options.frames, "Hard frames of each kind")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str();
  command->add_option("--seed", options.seed, "Seed of views, light and noise")->capture_default_str();
  command->add_option("--peers", options.peers, "Detectors to compare with")
      ->delimiter(',')
      ->check(CLI::IsMember({"apriltag", "aruco", "none"}))
      ->capture_default_str();
  std::vector<std::string> sweeps = sweep_names();
  sweeps.insert(sweeps.end(), {"all", "none"});
  command->add_option("--sweep", arguments->sweeps, "What to sweep")
      ->delimiter(',')
      ->check(CLI::IsMember(sweeps))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "As JSON");
  command->add_flag("--quiet", arguments->quiet, "No progress bar");
  command->add_option("-o,--output", arguments->folder, "Folder for localize.html and localize.json");
  return {command, [arguments] { return run(*arguments); }};
}

}  // namespace lodestar
