#include "app/console/run_heat.hpp"

#include <algorithm>
#include <cmath>

#include "app/common/rounding.hpp"

namespace lodestar {
namespace {

using nlohmann::ordered_json;

constexpr double seen_for_s = 0.5;      // after a fix; the camera gives some a second
constexpr double longest_step_s = 0.5;  // between two rows of a run that goes on

/// The index of the first row that is later; rows begin with their stamps, which ascend.
std::size_t first_after(const ordered_json& rows, std::size_t from, double time_s) {
  while (from < rows.size() && rows[from][0].get<double>() <= time_s) ++from;
  return from;
}

/// Distance of the truth, interpolated, from the estimate of a step; negative beyond the ends of the truth.
double error_at(const ordered_json& truth, std::size_t after, double time_s, double x_m, double y_m) {
  if (after == 0 || after >= truth.size()) return -1.0;
  const ordered_json& a = truth[after - 1];
  const ordered_json& b = truth[after];
  const double step_s = b[0].get<double>() - a[0].get<double>();
  const double share = step_s > 0.0 ? (time_s - a[0].get<double>()) / step_s : 0.0;
  const auto between = [&](std::size_t column) {
    return a[column].get<double>() + share * (b[column].get<double>() - a[column].get<double>());
  };
  return std::hypot(between(1) - x_m, between(2) - y_m);
}

}  // namespace

RunHeat::Square& RunHeat::at(double x_m, double y_m) {
  return squares_[{static_cast<int>(std::floor(x_m / square_m)),
                   static_cast<int>(std::floor(y_m / square_m))}];
}

void RunHeat::add(const ordered_json& run) {
  add_steps(run);
  add_waits(run);
}

void RunHeat::add_steps(const ordered_json& run) {
  constexpr std::size_t sigma_column = 4;
  constexpr std::size_t accepted_column = 5;
  const ordered_json& steps = run.at("steps");
  const ordered_json& fixes = run.at("fixes");
  const ordered_json& truth = run.at("truth");
  std::size_t next_fix = 0;
  std::size_t next_truth = 0;
  double seen_s = -1e9;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const ordered_json& step = steps[i];
    if (step.size() <= sigma_column) continue;
    const auto time_s = step[0].get<double>();
    const auto x_m = step[1].get<double>();
    const auto y_m = step[2].get<double>();
    Square& square = at(x_m, y_m);
    square.sigma_m = std::max(square.sigma_m, step[sigma_column].get<double>());
    for (; next_fix < fixes.size() && fixes[next_fix][0].get<double>() <= time_s; ++next_fix) {
      const ordered_json& fix = fixes[next_fix];
      if (fix.size() > accepted_column && fix[accepted_column].get<double>() > 0.0)
        seen_s = fix[0].get<double>();
    }
    const double step_s = i > 0 ? time_s - steps[i - 1][0].get<double>() : 0.0;
    if (time_s - seen_s > seen_for_s) square.blind_s += std::clamp(step_s, 0.0, longest_step_s);
    next_truth = first_after(truth, next_truth, time_s);
    square.error_m = std::max(square.error_m, error_at(truth, next_truth, time_s, x_m, y_m));
  }
}

void RunHeat::add_waits(const ordered_json& run) {
  const ordered_json& summary = run.at("summary");
  if (!summary.is_object() || !summary.contains("waits")) return;
  for (const ordered_json& wait : summary["waits"])
    at(wait.at("x_m").get<double>(), wait.at("y_m").get<double>()).waiting_s +=
        wait.at("duration_s").get<double>();
}

void RunHeat::add(const RunHeat& other) {
  for (const auto& [place, theirs] : other.squares_) {
    Square& ours = squares_[place];
    ours.sigma_m = std::max(ours.sigma_m, theirs.sigma_m);
    ours.error_m = std::max(ours.error_m, theirs.error_m);
    ours.blind_s += theirs.blind_s;
    ours.waiting_s += theirs.waiting_s;
  }
}

ordered_json RunHeat::json() const {
  ordered_json squares = ordered_json::array();
  for (const auto& [place, square] : squares_) {
    ordered_json error_mm = nullptr;
    if (square.error_m >= 0.0) error_mm = rounded(1000.0 * square.error_m, 10.0);
    squares.push_back({(place.first + 0.5) * square_m, (place.second + 0.5) * square_m,
                       rounded(3000.0 * square.sigma_m, 10.0), error_mm, rounded(square.blind_s, 100.0),
                       rounded(square.waiting_s, 100.0)});
  }
  return {{"square_m", square_m}, {"squares", squares}};
}

}  // namespace lodestar
