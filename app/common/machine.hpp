#pragma once

#include <string>

// What figures were measured on, and by which build: so that whoever reads them can compare.
namespace lodestar {

struct Machine {
  std::string processor;  ///< its model, as the kernel names it
  int cores = 0;          ///< that this process may use
  double memory_gb = 0.0;
  std::string system;  ///< distribution and kernel
  double load = 0.0;   ///< processes that wanted to run, mean of the last minute
};

/// Of the contents of /proc/cpuinfo, /proc/meminfo, /etc/os-release and /proc/loadavg; what is not in them is
/// "unknown" or 0. Cores and kernel are left to the caller.
Machine machine_from(const std::string& cpuinfo, const std::string& meminfo, const std::string& os_release,
                     const std::string& loadavg);

/// The machine that runs this program.
Machine this_machine();

/// How this program was built.
struct Build {
  std::string compiler;
  bool is_optimized = false;
  std::string commit;  ///< "unknown" where the program was built from an archive
};
Build this_build();

}  // namespace lodestar
