#include "app/drive/doctor.hpp"

#include <algorithm>
#include <fmt/core.h>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands/commands.hpp"
#include "app/common/json_text.hpp"
#include "app/drive/service_findings.hpp"
#include "app/site/site_folder.hpp"

namespace lodestar {
namespace {

struct DoctorArguments {
  std::string site;
  std::string interface;
  bool json = false;
  bool fix = false;
};

const char* word_for(Verdict verdict) {
  switch (verdict) {
    case Verdict::good:
      return "ok";
    case Verdict::doubtful:
      return "??";
    case Verdict::bad:
      return "NO";
  }
  return "";
}

const char* key_of(Verdict verdict) {
  return verdict == Verdict::good ? "good" : verdict == Verdict::doubtful ? "doubtful" : "bad";
}

void print(const Finding& finding) {
  fmt::print("{}  {:<12} {}\n", word_for(finding.verdict), finding.what, finding.found);
  if (!finding.remedy.empty()) fmt::print("    {:<12} -> {}\n", "", finding.remedy);
}

void print_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json report = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    report.push_back({{"what", finding.what},
                      {"verdict", key_of(finding.verdict)},
                      {"found", finding.found},
                      {"remedy", finding.remedy}});
  }
  fmt::print("{}", json_document(report));
}

ExitCode doctor_command(const DoctorArguments& arguments) {
  const Site site = open_site(arguments.site);
  const std::vector<Finding> findings = examine(site, connection_of(site, arguments.interface));
  if (arguments.fix) {
    fmt::print("{}", fix_script(findings));
  } else if (arguments.json) {
    print_json(findings);
  } else {
    for (const Finding& finding : findings) print(finding);
  }
  const bool may_move =
      std::ranges::none_of(findings, [](const Finding& finding) { return finding.verdict == Verdict::bad; });
  return may_move ? done : job_failed;
}

}  // namespace

std::vector<Command> doctor_commands(CLI::App& lodestar) {
  const auto arguments = std::make_shared<DoctorArguments>();
  CLI::App* command = lodestar.add_subcommand("doctor",
                                              "Diagnose why a robot does not move: a line for each check, "
                                              "with a remedy; exit 1 when one fails. Sends nothing");
  command
      ->add_option("site", arguments->site,
                   "Site folder, or the name of a site in /etc/lodestar or /srv/lodestar")
      ->required();
  command->add_option("--can", arguments->interface, "CAN interface; default: the site's");
  CLI::Option* json = command->add_flag("--json", arguments->json, "As JSON");
  command
      ->add_flag(
          "--fix", arguments->fix,
          "Print the commands that would set up CAN and the service, for you to read and run; runs none")
      ->excludes(json);
  return {{command, [arguments] { return doctor_command(*arguments); }}};
}

}  // namespace lodestar
