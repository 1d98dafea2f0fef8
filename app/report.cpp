#include "app/report.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "app/plot.hpp"
#include "app/run_statistics.hpp"

namespace lodestar {
namespace {

constexpr double mm_per_m = 1000.0;

constexpr const char* style = R"(
:root { color-scheme: light dark; --ink: #222; --soft: #777; --line: #ddd; --page: #fff;
  --a: #1f5fbf; --b: #d0342c; --band: #9db8dd55; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e6e6; --soft: #9a9a9a; --line: #444; --page: #16181b;
  --a: #6ea8ff; --b: #ff7a70; --band: #6ea8ff33; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--page); max-width: 960px;
  margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; margin: 0 0 .3rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem; }
p.lead { color: var(--soft); margin: 0 0 1rem; }
table { border-collapse: collapse; width: 100%; } th, td { text-align: right; padding: .3rem .6rem;
  border-bottom: 1px solid var(--line); font-variant-numeric: tabular-nums; }
th:first-child, td:first-child { text-align: left; }
img { width: 100%; border: 1px solid var(--line); background: #fff; }
svg { width: 100%; margin: .6rem 0; break-inside: avoid; }
svg text { fill: var(--ink); font: 12px system-ui, sans-serif; } svg .title { font-size: 14px; font-weight: 600; }
svg .unit, svg .tick { fill: var(--soft); font-weight: 400; } svg .grid { stroke: var(--line); }
.a, .b { fill: none; stroke-width: 1.3; stroke-linejoin: round; } .a { stroke: var(--a); } .b { stroke: var(--b); }
.band { fill: var(--band); stroke: none; } .key.a { fill: var(--a); } .key.b { fill: var(--b); }
)";

std::string base64(const std::string& bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? letters[(group >> (18U - 6U * k)) & 63U] : '=';
    }
  }
  return text;
}

std::string goal_row(const GoalRecord& goal) {
  const std::string error =
      goal.score ? fmt::format("{:.1f} mm", mm_per_m * goal.score->position_error_m) : "";
  std::string heading;
  if (goal.score && goal.score->heading_error_rad)
    heading = fmt::format("{:.2f}°", degrees(*goal.score->heading_error_rad));
  return fmt::format(
      "<tr><td>{:.2f}, {:.2f}</td><td>{}</td><td>{:.2f} m</td><td>{:.1f} s</td><td>{}</td><td>{}</td></tr>\n",
      goal.goal.position_m.x(), goal.goal.position_m.y(),
      goal.arrived ? "arrived" : escaped("not reached: " + goal.failure), length_m(goal.planned),
      seconds(goal.travel_time), error, heading);
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
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\">"
      "<title>Lodestar: {}, seed {}</title><style>{}</style></head><body>\n",
      escaped(record.site), record.seed, style);
  html += fmt::format(
      "<h1>{}: {}</h1>\n<p class=\"lead\">Camera {}, seed {}. {:.1f} m driven in {:.1f} s, {} contacts, {} "
      "of {} fixes "
      "accepted from {} frames. Repeat with <code>{}</code></p>\n",
      escaped(record.site), record.arrived() ? "arrived" : "not arrived", escaped(record.camera), record.seed,
      summary["driven_m"].get<double>(), summary["time_s"].get<double>(), record.contacts,
      summary["fixes_accepted"].get<int>(), record.fixes.size(), record.frames, escaped(record.repeat));
  html += fmt::format("<img alt=\"Map, planned and driven track\" src=\"data:image/png;base64,{}\">\n",
                      base64(map_png));
  html +=
      "<h2>Goals</h2>\n<table><tr><th>Goal (m)</th><th>End</th><th>Planned</th><th>Time</th><th>Off "
      "by</th><th>Heading off by</th></tr>\n";
  for (const GoalRecord& goal : record.goals) html += goal_row(goal);
  html +=
      "</table>\n<h2>Errors against the truth</h2>\n<table><tr><th></th><th>median</th><th>95 "
      "%</th><th>largest</th></tr>\n";
  html += fact_row("Track from the planned curve", summary["path_distance_m"], mm_per_m, " mm");
  html += fact_row("Position of the estimate", summary["estimate_position_error_m"], mm_per_m, " mm");
  html += fact_row("Heading of the estimate", summary["estimate_heading_error_deg"], 1.0, "°");
  html +=
      "</table>\n<h2>Over time (s)</h2>\n" + estimate_plots(record) + path_plot(record) + drive_plots(record);
  return html + "</body></html>\n";
}

}  // namespace lodestar
