#include "app/commands/served_run.hpp"

#include "app/commands/console_options.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

ConsoleServiceOptions console_options(const Site& site, const ServedRunOptions& options) {
  check_tokens(options.console.access);
  ConsoleServiceOptions console = options.console;
  console.site = site.folder;
  console.runs = options.output.empty() ? fs::path(options.runs) : fs::absolute(options.output).parent_path();
  return console;
}

}  // namespace

ServedRun::ServedRun(const Site& site, const ServedRunOptions& options, RunOptions& run,
                     const DrivenSurvey* survey)
    : surveys_(survey != nullptr),
      service_(console_options(site, options), &link_, surveys_ ? survey->live() : nullptr),
      runs_(options.output.empty() ? fs::path(options.runs) / site.name : fs::path(options.output),
            !options.output.empty(), site, run.camera, {.interface = options.interface}) {
  if (!surveys_) run.watch = runs_.watcher();
  run.session = &session_;
  run.hold_on_base_fault = true;
  run.keep = [this](RunRecord record) { keep(std::move(record)); };
  tell_address(options.console.access, service_.port());
  thread_.emplace(service_);
}

void ServedRun::keep(RunRecord record) {
  if (record.goals.empty()) return;
  all_arrived_ = all_arrived_ && record.arrived();
  if (!surveys_) runs_.keep(std::move(record));
}

}  // namespace lodestar
