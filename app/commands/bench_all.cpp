#include "app/commands/bench_all.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <memory>

#include "app/bench/evidence_page.hpp"
#include "app/bench/evidence_parts.hpp"
#include "app/common/interruption.hpp"
#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct BenchAllArguments {
  std::string folder = "evidence";
  std::vector<std::string> only;
  bool quick = false;
  bool quiet = false;
};

void make_evidence_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder / "raw", failed);
  if (failed) throw InputError(folder, 0, "no folder that can be made", "a folder to write to");
}

/// A campaign does not write where an earlier one has.
void remove_earlier_campaign(const fs::path& folder) {
  std::error_code cannot;
  if (fs::exists(folder / "missions.jsonl", cannot)) fs::remove_all(folder, cannot);
}

ProgramEnd run_part(const EvidencePart& part, std::vector<std::string> arguments, const fs::path& folder) {
  const fs::path self = fs::read_symlink("/proc/self/exe");
  const fs::path program = part.program == "lodestar" ? self : self.parent_path() / part.program;
  remove_earlier_campaign(folder / part.name);
  for (std::string& word : arguments) {
    constexpr std::string_view placeholder = "{folder}";
    if (word.starts_with(placeholder)) word.replace(0, placeholder.size(), folder.string());
  }
  return run_program_to_end(program, arguments, folder / "raw" / (part.name + ".out"),
                            folder / "raw" / (part.name + ".err"));
}

/// A benchmark of this source tree, which an installed program has not.
bool is_built(const EvidencePart& part) {
  std::error_code cannot;
  return part.program == "lodestar" ||
         fs::exists(fs::read_symlink("/proc/self/exe", cannot).parent_path() / part.program, cannot);
}

EvidenceSection section_of(const EvidencePart& part, const BenchAllArguments& arguments) {
  const auto without = [&](EvidenceStanding standing, const std::string& why) {
    return without_figures(part, arguments.quick, standing, why);
  };
  if (!arguments.only.empty() && std::ranges::find(arguments.only, part.name) == arguments.only.end())
    return without(EvidenceStanding::left_out, "not asked for (--only)");
  if (Interruption::asked()) return without(EvidenceStanding::left_out, "interrupted before");
  if (!is_built(part))
    return without(EvidenceStanding::not_possible,
                   part.program + " is not beside this program: built without LODESTAR_BENCH, or installed");
  if (!arguments.quiet) fmt::print(stderr, "bench all: {}\n", part.name);
  return gather(part, arguments.quick, [&](const EvidencePart& each, const std::vector<std::string>& words) {
    return run_part(each, words, arguments.folder);
  });
}

ExitCode run_all_benches(const BenchAllArguments& arguments) {
  const fs::path folder = arguments.folder;
  make_evidence_folder(folder);
  const Interruption interruption;
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  Evidence evidence{.version = LODESTAR_VERSION,
                    .date = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(now)),
                    .quick = arguments.quick,
                    .machine = this_machine(),
                    .build = this_build()};
  for (const EvidencePart& part : evidence_parts()) evidence.sections.push_back(section_of(part, arguments));
  write_file_atomically(folder / "index.html", evidence_html(evidence));
  fmt::print("{}", evidence_text(evidence));
  if (!arguments.quiet) fmt::print(stderr, "bench all: wrote {}\n", (folder / "index.html").string());
  return evidence.holds() ? done : job_failed;
}

}  // namespace

Command bench_all_command(CLI::App& bench) {
  const auto arguments = std::make_shared<BenchAllArguments>();
  CLI::App* command = bench.add_subcommand(
      "all", "Every promise with today's figure on one page; exit 1 when one is missed or a command fails");
  std::vector<std::string> names;
  for (const EvidencePart& part : evidence_parts()) names.push_back(part.name);
  command->add_option("-o,--output", arguments->folder, "Folder for index.html and what each command printed")
      ->capture_default_str();
  command->add_option("--only", arguments->only, "These parts; the others are on the page as left out")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  command->add_flag(
      "--quick", arguments->quick,
      "Few trials, minutes instead of an hour: shows that it works, judges only what one case breaks");
  command->add_flag("--quiet", arguments->quiet, "Do not say which part is running");
  return {command, [arguments] { return run_all_benches(*arguments); }};
}

}  // namespace lodestar
