#include "app/common/machine.hpp"

#include <cstdlib>
#include <fmt/format.h>
#include <sched.h>
#include <sstream>
#include <sys/utsname.h>

#include "app/common/program_data.hpp"
#include "maps/file_text.hpp"

namespace lodestar {
namespace {

constexpr double kb_per_gb = 1024.0 * 1024.0;

/// Empty where it cannot be read.
std::string content_of(const std::filesystem::path& file) {
  return file_text(file).value_or("");
}

/// What stands behind the first line that begins with `key`, without blanks, quotes and the separator; empty:
/// no such line.
std::string value_of(const std::string& text, const std::string& key) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t first = line.find_first_not_of(" \t:=\"", key.size());
    if (first == std::string::npos) return "";
    return line.substr(first, line.find_last_not_of(" \t\"") + 1 - first);
  }
  return "";
}

std::string or_unknown(const std::string& text) {
  return text.empty() ? "unknown" : text;
}

int usable_cores() {
  cpu_set_t usable;
  return ::sched_getaffinity(0, sizeof usable, &usable) == 0 ? CPU_COUNT(&usable) : 0;
}

}  // namespace

Machine machine_from(const std::string& cpuinfo, const std::string& meminfo, const std::string& os_release,
                     const std::string& loadavg) {
  return {.processor = or_unknown(value_of(cpuinfo, "model name")),
          .memory_gb = std::strtod(value_of(meminfo, "MemTotal").c_str(), nullptr) / kb_per_gb,
          .system = or_unknown(value_of(os_release, "PRETTY_NAME")),
          .load = std::strtod(loadavg.c_str(), nullptr)};
}

Machine this_machine() {
  Machine machine = machine_from(content_of("/proc/cpuinfo"), content_of("/proc/meminfo"),
                                 content_of("/etc/os-release"), content_of("/proc/loadavg"));
  machine.cores = usable_cores();
  utsname kernel{};
  if (::uname(&kernel) == 0)
    machine.system += fmt::format(", {} {} {}", kernel.sysname, kernel.release, kernel.machine);
  return machine;
}

Build this_build() {
#ifdef __clang__
  constexpr const char* name = "";
#else
  constexpr const char* name = "g++ ";
#endif
#ifdef __OPTIMIZE__
  constexpr bool is_optimized = true;
#else
  constexpr bool is_optimized = false;
#endif
  std::error_code cannot;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", cannot);
  const auto file = data_beside(program.parent_path(), "commit");
  return {.compiler = std::string(name) + __VERSION__,
          .is_optimized = is_optimized,
          .commit = or_unknown(file ? value_of(content_of(*file), "commit") : "")};
}

}  // namespace lodestar
