#include "app/common/process_health.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace lodestar {
namespace {

constexpr double shortest_ms = 1e-3;

}  // namespace

ProcessHealth process_health() {
  ProcessHealth health;
  std::ifstream statm("/proc/self/statm");
  std::int64_t all_pages = 0;
  std::int64_t resident_pages = 0;
  constexpr std::int64_t bytes_per_kb = 1024;
  if (statm >> all_pages >> resident_pages)
    health.resident_kb = resident_pages * sysconf(_SC_PAGESIZE) / bytes_per_kb;
  std::error_code none;
  const std::filesystem::directory_iterator open_files("/proc/self/fd", none);
  health.descriptors = static_cast<int>(std::distance(begin(open_files), end(open_files)));
  return health;
}

void TimeHistogram::add(std::chrono::nanoseconds time) {
  const double ms = std::chrono::duration<double, std::milli>(time).count();
  const double steps = steps_per_decade * std::log10(std::max(ms, shortest_ms) / shortest_ms);
  const auto bin = std::min(bins_.size() - 1, static_cast<std::size_t>(steps));
  ++bins_[bin];
  ++count_;
  max_ms_ = std::max(max_ms_, ms);
}

std::optional<double> TimeHistogram::quantile_ms(double share) const {
  if (count_ == 0) return std::nullopt;
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    seen += bins_[bin];
    if (seen >= wanted && seen > 0) {
      const double upper_ms = shortest_ms * std::pow(10.0, static_cast<double>(bin + 1) / steps_per_decade);
      return std::min(upper_ms, max_ms_);
    }
  }
  return max_ms_;
}

}  // namespace lodestar
