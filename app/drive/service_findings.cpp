#include "app/drive/service_findings.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <optional>
#include <sstream>
#include <sys/stat.h>

#include "maps/file_text.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view user = "lodestar";

/// The service's user, from /etc/passwd; nothing when there is none.
std::optional<std::string> number_of_user(const ServicePlaces& places) {
  std::istringstream lines(file_text(places.root / "etc/passwd").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(std::string(user) + ":")) continue;
    const std::size_t number = line.find(':', user.size() + 1) + 1;
    return line.substr(number, line.find(':', number) - number);
  }
  return std::nullopt;
}

bool belongs_to(const fs::path& folder, const std::string& number) {
  struct stat found{};
  return ::stat(folder.c_str(), &found) == 0 && std::to_string(found.st_uid) == number &&
         (found.st_mode & S_IWUSR) != 0;
}

bool is_unit_installed(const ServicePlaces& places) {
  constexpr std::array folders{"etc/systemd/system", "usr/lib/systemd/system", "lib/systemd/system"};
  return std::ranges::any_of(
      folders, [&](const char* folder) { return is_file(places.root / folder / "lodestar@.service"); });
}

/// systemd gives each running unit a control group of its name.
bool is_running(const std::string& site, const ServicePlaces& places) {
  const fs::path group = places.root / "sys/fs/cgroup/system.slice/system-lodestar.slice" /
                         fmt::format("lodestar@{}.service", site) / "cgroup.procs";
  return !file_text(group).value_or("").empty();
}

bool is_enabled(const std::string& site, const ServicePlaces& places) {
  const fs::path link =
      places.root / "etc/systemd/system/multi-user.target.wants" / fmt::format("lodestar@{}.service", site);
  return fs::symlink_status(link).type() == fs::file_type::symlink;
}

Finding look_at_unit(const ServiceSite& site, const ServicePlaces& places) {
  if (!is_unit_installed(places)) {
    return {.what = "service",
            .verdict = Verdict::doubtful,
            .found = "lodestar@.service is not installed",
            .remedy = "install the package lodestar, if the robot is to start by itself"};
  }
  const std::string unit = fmt::format("lodestar@{}", site.name);
  const bool runs = is_running(site.name, places);
  const bool starts = is_enabled(site.name, places);
  Finding finding{.what = "service",
                  .found = fmt::format("{} {}, and {} at boot", unit, runs ? "runs" : "does not run",
                                       starts ? "starts" : "does not start")};
  if (runs && starts) return finding;
  finding.verdict = Verdict::doubtful;
  finding.remedy = fmt::format("if the robot is to start by itself: sudo systemctl enable --now {}", unit);
  finding.commands = fmt::format("sudo systemctl enable --now {}\n", unit);
  return finding;
}

/// The service finds sites by name, and its console saves markers in them.
Finding look_at_site_folder(const ServiceSite& site, const ServicePlaces& places,
                            const std::string& user_number) {
  const fs::path parent = site.folder.parent_path();
  const bool is_found = parent == places.root / "etc/lodestar" || parent == places.root / "srv/lodestar";
  Finding finding{.what = "site folder",
                  .found = fmt::format("{} belongs to {}", site.folder.string(), user)};
  if (is_found && belongs_to(site.folder, user_number)) return finding;
  finding.verdict = Verdict::doubtful;
  const fs::path target = is_found ? site.folder : places.root / "etc/lodestar" / site.name;
  if (is_found) {
    finding.found =
        fmt::format("{} does not belong to {}: the console cannot save", site.folder.string(), user);
  } else {
    finding.found = fmt::format("{} is not where the service looks", site.folder.string());
    finding.commands = fmt::format("sudo cp -r '{}' '{}'\n", site.folder.string(), target.string());
  }
  finding.commands += fmt::format("sudo chown -R {0}:{0} '{1}'\n", user, target.string());
  finding.remedy = "for the service, see doctor --fix";
  return finding;
}

Finding look_at_state(const ServiceSite& site, const ServicePlaces& places, const std::string& user_number) {
  const fs::path folder = places.root / "var/lib/lodestar" / site.name;
  Finding finding{.what = "state", .found = folder.string()};
  if (!is_folder(folder)) {
    finding.found += " is made when the service starts";
    return finding;
  }
  if (belongs_to(folder, user_number)) return finding;
  finding.verdict = Verdict::bad;
  finding.found += fmt::format(" does not belong to {}: what the robot learns is not kept", user);
  finding.commands = fmt::format("sudo chown -R {0}:{0} '{1}'\n", user, folder.string());
  finding.remedy = finding.commands.substr(0, finding.commands.size() - 1);
  return finding;
}

/// Is there a file of systemd-networkd that brings this interface up?
bool is_brought_up(const std::string& interface, const ServicePlaces& places) {
  for (const char* folder : {"etc/systemd/network", "usr/lib/systemd/network"}) {
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(places.root / folder, none)) {
      if (entry.path().extension() != ".network") continue;
      const std::string text = file_text(entry.path()).value_or("");
      const bool is_can = text.find("[CAN]") != std::string::npos;
      if (is_can && text.find("Name=" + interface) != std::string::npos) return true;
    }
  }
  return false;
}

Finding look_at_can_at_boot(const ServiceSite& site, const ServicePlaces& places) {
  if (is_brought_up(site.interface, places))
    return {.what = "CAN at boot", .found = site.interface + " is brought up by systemd-networkd"};
  const std::string file = fmt::format("/etc/systemd/network/80-{}.network", site.interface);
  return {.what = "CAN at boot",
          .verdict = Verdict::doubtful,
          .found = site.interface + " is in no file of systemd-networkd",
          .remedy = "for one, see doctor --fix",
          .commands = fmt::format("sudo tee {} <<'END'\n[Match]\nName={}\n\n[CAN]\nBitRate={}\n"
                                  "# After bus-off.\nRestartSec=100ms\nEND\n"
                                  "sudo systemctl enable --now systemd-networkd\nsudo networkctl reload\n",
                                  file, site.interface, site.bit_rate_bps)};
}

}  // namespace

std::vector<Finding> look_at_service(const ServiceSite& site, const ServicePlaces& places) {
  if (!is_folder(places.root / "run/systemd/system")) return {};
  std::vector<Finding> findings;
  if (!site.is_virtual_interface) findings.push_back(look_at_can_at_boot(site, places));
  if (const std::optional<std::string> number = number_of_user(places); number && is_unit_installed(places)) {
    findings.push_back(look_at_site_folder(site, places, *number));
    findings.push_back(look_at_state(site, places, *number));
  }
  findings.push_back(look_at_unit(site, places));
  return findings;
}

std::string fix_script(const std::vector<Finding>& findings) {
  std::string script;
  for (const Finding& finding : findings)
    if (!finding.commands.empty())
      script += fmt::format("# {}: {}\n{}", finding.what, finding.found, finding.commands);
  return script;
}

}  // namespace lodestar
