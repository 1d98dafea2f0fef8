#include "app/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "app/common/base64.hpp"
#include "app/report/page.hpp"
#include "app/report/plot.hpp"
#include "app/report/run_statistics.hpp"

namespace lodestar {
namespace {

std::string goal_row(const GoalRecord& goal, const std::optional<ArrivalScore>& score) {
  const std::string error = score ? fmt::format("{:.1f} mm", mm_per_m * score->position_error_m) : "";
  std::string heading;
  if (score && score->heading_error_rad) heading = fmt::format("{:.2f}°", degrees(*score->heading_error_rad));
  return fmt::format(
      "<tr><td>{:.2f}, {:.2f}</td><td>{}</td><td>{:.2f} m</td><td>{:.1f} s</td><td>{}</td><td>{}</td></tr>\n",
      goal.goal.position_m.x(), goal.goal.position_m.y(),
      goal.arrived ? "arrived" : escaped("not reached: " + goal.failure), length_m(goal.planned),
      seconds(goal.travel_time), error, heading);
}

std::string waits_table(const std::vector<Wait>& waits) {
  if (waits.empty()) return {};
  std::string html =
      "<h2>Where it waited, and why</h2>\n<table><tr><th>Why</th><th>From</th><th>For</th><th>At "
      "(m)</th></tr>\n";
  for (const Wait& wait : waits) {
    html += fmt::format("<tr><td>{}</td><td>{:.1f} s</td><td>{:.1f} s</td><td>{:.2f}, {:.2f}</td></tr>\n",
                        escaped(wait.why), seconds(wait.from), seconds(wait.to - wait.from),
                        wait.position_m.x(), wait.position_m.y());
  }
  return html + "</table>\n";
}

std::string faults_table(const std::vector<FaultEvent>& faults) {
  if (faults.empty()) return {};
  std::string html =
      "<h2>Faults injected</h2>\n<table><tr><th>Fault</th><th>From</th><th>To</th><th>Marker</th></tr>\n";
  for (const FaultEvent& fault : faults) {
    html += fmt::format("<tr><td>{}</td><td>{:.2f} s</td><td>{}</td><td>{}</td></tr>\n",
                        to_string(fault.kind), seconds(fault.begin),
                        fault.end ? fmt::format("{:.2f} s", seconds(*fault.end)) : "the end",
                        fault.marker ? fmt::format("{}", *fault.marker) : "");
  }
  return html + "</table>\n";
}

std::string fact_row(const std::string& name, const nlohmann::ordered_json& spread, double factor,
                     const std::string& unit) {
  std::string row = fmt::format("<tr><td>{}</td>", name);
  for (const auto& value : spread) {
    row += value.is_null() ? "<td>none</td>"
                           : fmt::format("<td>{:.2f}{}</td>", factor * value.get<double>(), unit);
  }
  return row + "</tr>\n";
}

std::string estimate_plots(const RunRecord& record) {
  PlotSeries position{"error", "a", {}, false};
  PlotSeries position_band{"3 sigma", "band", {}, true};
  PlotSeries heading{"error", "a", {}, false};
  PlotSeries heading_band{"3 sigma", "band", {}, true};
  for (const EstimateError& error : estimate_errors(record)) {
    position.points.emplace_back(error.time_s, mm_per_m * error.position_m);
    position_band.points.emplace_back(error.time_s, 3.0 * mm_per_m * error.position_sigma_m);
    heading.points.emplace_back(error.time_s, degrees(std::abs(error.heading_rad)));
    heading_band.points.emplace_back(error.time_s, 3.0 * degrees(error.heading_sigma_rad));
  }
  return plot_svg("Position error of the estimate", "mm", {position_band, position}) +
         plot_svg("Heading error of the estimate", "degrees", {heading_band, heading});
}

/// The filter's own output: standard deviations, and the estimated wheel scales.
std::string filter_plots(const RunRecord& record) {
  PlotSeries sigma_x{"sigma x", "a", {}, false};
  PlotSeries sigma_y{"sigma y", "b", {}, false};
  PlotSeries sigma_yaw{"sigma heading", "c", {}, false};
  PlotSeries left{"left", "a", {}, false};
  PlotSeries right{"right", "b", {}, false};
  for (const StepRecord& step : record.steps) {
    const double time_s = seconds(step.estimate.stamp);
    const Eigen::Matrix3d& covariance = step.estimate.covariance;
    sigma_x.points.emplace_back(time_s, mm_per_m * std::sqrt(covariance(0, 0)));
    sigma_y.points.emplace_back(time_s, mm_per_m * std::sqrt(covariance(1, 1)));
    sigma_yaw.points.emplace_back(time_s, degrees(std::sqrt(covariance(2, 2))));
    left.points.emplace_back(time_s, 100.0 * (step.wheel_scales.x() - 1.0));
    right.points.emplace_back(time_s, 100.0 * (step.wheel_scales.y() - 1.0));
  }
  return plot_svg("Standard deviation of the position", "mm", {sigma_x, sigma_y}) +
         plot_svg("Standard deviation of the heading", "degrees", {sigma_yaw}) +
         plot_svg("Wheels roll farther than they report, as learned", "%", {left, right});
}

std::string path_plot(const RunRecord& record) {
  PlotSeries distance{"distance", "a", {}, false};
  const std::vector<std::vector<TruePose>> parts = parts_of_track(record);
  for (std::size_t goal = 0; goal < std::min(parts.size(), record.goals.size()); ++goal) {
    const Path& planned = record.goals[goal].planned;
    if (planned.waypoints_m.empty()) continue;
    for (const TruePose& pose : parts[goal]) {
      const double distance_m = distance_to_path_m(planned, pose.map_from_base.position_m);
      distance.points.emplace_back(seconds(pose.stamp), mm_per_m * distance_m);
    }
  }
  return plot_svg("Distance of the track from the planned curve", "mm", {distance});
}

std::string drive_plots(const RunRecord& record) {
  PlotSeries commanded{"commanded", "b", {}, false};
  PlotSeries measured{"measured", "a", {}, false};
  PlotSeries turn_commanded{"commanded", "b", {}, false};
  PlotSeries turn_measured{"measured", "a", {}, false};
  for (const StepRecord& step : record.steps) {
    const double time_s = seconds(step.estimate.stamp);
    commanded.points.emplace_back(time_s, step.commanded.forward_mps);
    measured.points.emplace_back(time_s, step.measured.forward_mps);
    turn_commanded.points.emplace_back(time_s, degrees(step.commanded.turn_radps));
    turn_measured.points.emplace_back(time_s, degrees(step.measured.turn_radps));
  }
  PlotSeries confidence{"P(S)", "a", {}, false};
  for (const FixRecord& fix : record.fixes)
    confidence.points.emplace_back(seconds(fix.stamp), fix.confidence);
  return plot_svg("Forward speed", "m/s", {commanded, measured}) +
         plot_svg("Turn rate", "degrees/s", {turn_commanded, turn_measured}) +
         plot_svg("Confidence of the optimal marker", "Eq. (3)", {confidence});
}

}  // namespace

std::string report_html(const RunRecord& record, const std::string& map_png) {
  const nlohmann::ordered_json summary = summary_of(record);
  std::string html;
  html += fmt::format(
      "<h1>{}: {}</h1>\n<p class=\"lead\">Camera {}, seed {}. {:.1f} m driven in {:.1f} s, {} contacts, {} "
      "of {} fixes accepted from {} frames. Repeat with <code>{}</code></p>\n",
      escaped(record.site), record.arrived() ? "arrived" : "not arrived", escaped(record.camera), record.seed,
      summary["driven_m"].get<double>(), summary["time_s"].get<double>(), record.contacts,
      summary["fixes_accepted"].get<int>(), record.fixes.size(), record.frames, escaped(record.repeat));
  html += fmt::format("<img alt=\"Map, planned and driven track\" src=\"data:image/png;base64,{}\">\n",
                      base64(map_png));
  html +=
      "<h2>Goals</h2>\n<table><tr><th>Goal (m)</th><th>End</th><th>Planned</th><th>Time</th><th>Off "
      "by</th><th>Heading off by</th></tr>\n";
  for (std::size_t i = 0; i < record.goals.size(); ++i) html += goal_row(record.goals[i], record.score_of(i));
  html += "</table>\n" + waits_table(waits_of(record)) + faults_table(record.faults);
  html +=
      "<h2>Errors against the truth</h2>\n<table><tr><th></th><th>median</th><th>95 "
      "%</th><th>largest</th></tr>\n";
  html += fact_row("Track from the planned curve", summary["path_distance_m"], mm_per_m, " mm");
  html += fact_row("Position of the estimate", summary["estimate_position_error_m"], mm_per_m, " mm");
  html += fact_row("Heading of the estimate", summary["estimate_heading_error_deg"], 1.0, "°");
  html += "</table>\n<h2>Over time (s)</h2>\n" + estimate_plots(record) + filter_plots(record) +
          path_plot(record) + drive_plots(record);
  return page_html(fmt::format("Lodestar: {}, seed {}", record.site, record.seed), html);
}

}  // namespace lodestar
