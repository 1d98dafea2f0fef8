#include "app/simulate/run_table.hpp"

#include <algorithm>
#include <fmt/core.h>

#include "app/report/nees.hpp"

namespace lodestar {
namespace {

/// A dash where no goal was reached.
std::string in_words(const std::optional<double>& value, double scale, int digits) {
  return value ? fmt::format("{:.{}f}", scale * *value, digits) : "-";
}

void print_row(const RunSummary& run) {
  fmt::print("{:>6} {:>5}/{:<2} {:>11} {:>12} {:>12.1f} {:>9} {:>9.1f}  {}\n", run.seed, run.arrivals,
             run.goals, in_words(run.worst_position_m, 1000.0, 1),
             in_words(run.worst_heading_rad, degrees(1.0), 2), 1000.0 * run.path_p95_m, run.contacts,
             run.drive_s, run.failure);
}

/// Worst errors, sums of counts and times, and the mean NEES of all runs.
RunSummary worst_of(const std::vector<RunSummary>& runs) {
  RunSummary worst;
  for (const RunSummary& run : runs) {
    worst.goals += run.goals;
    worst.arrivals += run.arrivals;
    worst.worst_position_m = std::max(worst.worst_position_m, run.worst_position_m);
    worst.worst_heading_rad = std::max(worst.worst_heading_rad, run.worst_heading_rad);
    worst.path_p95_m = std::max(worst.path_p95_m, run.path_p95_m);
    worst.contacts += run.contacts;
    worst.drive_s += run.drive_s;
    worst.travel_s += run.travel_s;
    worst.ideal_s += run.ideal_s;
    worst.nees += run.nees / static_cast<double>(runs.size());
    worst.wall_s += run.wall_s;
  }
  return worst;
}

double worst_time_ratio(const std::vector<RunSummary>& runs) {
  double worst = 0.0;
  for (const RunSummary& run : runs)
    if (run.ideal_s > 0.0) worst = std::max(worst, run.travel_s / run.ideal_s);
  return worst;
}

void print_nees(const std::vector<RunSummary>& runs) {
  std::vector<std::vector<NeesSample>> samples;
  for (const RunSummary& run : runs) samples.push_back(run.nees_samples);
  const auto print = [&](std::string_view name, std::optional<NeesPhase> phase) {
    if (const std::optional<NeesVerdict> nees = nees_verdict(samples, phase)) {
      fmt::print("{:<12} {:>9.2f} {:>10.1f} % of {} s\n", name, nees->mean, 100.0 * nees->share_inside,
                 nees->seconds);
    }
  };
  const std::optional<NeesVerdict> all = nees_verdict(samples);
  if (!all) return;
  fmt::print("NEES, of 3; a mean over {} runs lies in {:.2f}..{:.2f} in 95 % of all seconds\n", runs.size(),
             all->low, all->high);
  fmt::print("{:<12} {:>9} {:>12}\n", "", "mean", "inside");
  for (const NeesPhase phase : {NeesPhase::start_up, NeesPhase::steady, NeesPhase::gap})
    print(to_string(phase), phase);
  print("whole drive", std::nullopt);
}

}  // namespace

void print_run_table(const std::vector<RunSummary>& runs, double cpu_s) {
  fmt::print("  seed  arrived  error (mm)  error (deg)  path95 (mm)  contacts  time (s)\n");
  for (const RunSummary& run : runs) print_row(run);
  const RunSummary worst = worst_of(runs);
  fmt::print(
      "all {} runs: {} of {} goals reached, {} contacts; worst: {} mm and {} deg from a goal, "
      "95 % of the track within {:.1f} mm of the path\n",
      runs.size(), worst.arrivals, worst.goals, worst.contacts, in_words(worst.worst_position_m, 1000.0, 1),
      in_words(worst.worst_heading_rad, degrees(1.0), 2), 1000.0 * worst.path_p95_m);
  if (worst.ideal_s > 0.0) {
    fmt::print("driving time {:.3f} x the ideal of the planned paths, worst run {:.3f} x\n",
               worst.travel_s / worst.ideal_s, worst_time_ratio(runs));
  }
  print_nees(runs);
  fmt::print(stderr, "{:.0f} x real time by one core's time\n", worst.drive_s / cpu_s);
}

}  // namespace lodestar
