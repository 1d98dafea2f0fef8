#include "app/bench/localize_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "app/report/page.hpp"
#include "app/report/plot.hpp"
#include "app/report/table.hpp"

namespace lodestar {
namespace {

std::string over_bound(double value, double bound) {
  return bound > 0.0 ? fmt::format("{:.2f}", value / bound) : std::string("-");
}

Table targets_table(const BenchLocalizeResult& result) {
  Table table{"Targets", {"", "measured", "wanted", ""}, {}};
  for (const Target& target : result.targets) {
    table.rows.push_back({target.name, fmt::format("{:.4g} {}", target.value, target.unit),
                          fmt::format("{} {:g} {}", target.at_least ? ">=" : "<=", target.limit, target.unit),
                          target.reached() ? "pass" : "FAIL"});
  }
  return table;
}

/// The bound is that of our marker's dots; for the peers it is a reference only.
std::vector<std::string> point_row(const std::string& name, const ScenePoint& point) {
  const PoseSpread& rms = point.upright;
  const PoseSpread& bound = point.upright_bound;
  return {name,
          fmt::format("{:.1f} %", 100.0 * point.share_read()),
          fmt::format("{}", point.wrong),
          fmt::format("{:.1f}", point.median_us),
          fmt::format("{:.1f}", point.threshold_us > 0.0 ? point.median_us / point.threshold_us : 0.0),
          fmt::format("{:.3f}", mm_per_m * rms.lateral_m),
          over_bound(rms.lateral_m, bound.lateral_m),
          fmt::format("{:.2f}", mm_per_m * rms.height_m),
          fmt::format("{:.4f}", degrees(rms.yaw_rad)),
          fmt::format("{:.2f}", mm_per_m * point.free.lateral_m),
          over_bound(point.free.lateral_m, point.free_bound.lateral_m)};
}

Table points_table(const std::string& title, const std::string& first = "") {
  return {title,
          {first, "read", "wrong", "us", "x threshold", "lateral mm", "x bound", "height mm", "yaw deg",
           "free lateral mm", "x bound"},
          {}};
}

Table scene_table(const BenchLocalizeResult& result, const std::string& title,
                  const std::vector<ScenePoint>& points) {
  Table table = points_table(title);
  for (std::size_t i = 0; i < points.size(); ++i)
    table.rows.push_back(point_row(result.methods[i].name, points[i]));
  return table;
}

Table megapixel_table(const BenchLocalizeResult& result) {
  Table table = points_table("Three markers in 1280 x 1024 pixels");
  table.rows.push_back(point_row(result.methods.front().name, result.megapixel));
  return table;
}

Table tried_table(const BenchLocalizeResult& result) {
  Table table = points_table("Settings of the peers, 0.5 m off axis: the best of each is kept");
  for (const TriedSettings& tried : result.tried)
    table.rows.push_back(
        point_row(fmt::format("{}: {}", tried.choice.name, tried.choice.settings), tried.point));
  return table;
}

Table counts_table(const BenchLocalizeResult& result) {
  Table table{"Hard frames",
              {"", "frames", "markers in full view", "read right", "wrong IDs", "markers where none is",
               "direction dot lost: read", "wrong"},
              {}};
  for (const MethodCounts& counts : result.counts) {
    table.rows.push_back({counts.method, fmt::format("{}", counts.adverse.frames),
                          fmt::format("{}", counts.adverse.markers), fmt::format("{}", counts.adverse.right),
                          fmt::format("{}", counts.adverse.wrong), fmt::format("{}", counts.empty.wrong),
                          fmt::format("{}", counts.direction_dot_lost.right),
                          fmt::format("{}", counts.direction_dot_lost.wrong)});
  }
  return table;
}

Table ceilings_table(const BenchLocalizeResult& result) {
  Table table{"Markers read by kind of ceiling, all bright but the last three",
              {"", "frames", "markers in full view", "read", "wrong IDs"},
              {}};
  for (const CeilingCounts& row : result.ceilings) {
    const double share = 100.0 * row.counts.read / std::max(row.counts.markers, 1);
    table.rows.push_back({row.name, fmt::format("{}", row.counts.frames),
                          fmt::format("{}", row.counts.markers), fmt::format("{:.2f} %", share),
                          fmt::format("{}", row.counts.wrong)});
  }
  return table;
}

Table consistency_table(const BenchLocalizeResult& result) {
  Table table{"Errors against the stated covariance: normalized squared error per degree of freedom",
              {"", "poses", "mean", "95 % band", ""},
              {}};
  for (const Consistency& one : result.consistency) {
    const double band = one.half_band_per_degree();
    table.rows.push_back({one.conditions, fmt::format("{}", one.poses),
                          fmt::format("{:.3f}", one.per_degree()),
                          fmt::format("{:.3f} to {:.3f}", 1.0 - band, 1.0 + band),
                          std::abs(one.per_degree() - 1.0) <= band ? "within" : "outside"});
  }
  return table;
}

Table reliability_table(const BenchLocalizeResult& result) {
  const std::vector<StatedOutcome>& stated = result.counts.front().adverse.stated;
  Table table{fmt::format("Stated confidence and share right, Brier score {:.4f}", brier_score(stated)),
              {"stated", "readings", "mean stated", "share right"},
              {}};
  for (const ReliabilityBin& bin : reliability(stated)) {
    table.rows.push_back({fmt::format("{:g} to {:g}", bin.low, bin.high), fmt::format("{}", bin.count),
                          fmt::format("{:.4f}", bin.mean_stated), fmt::format("{:.4f}", bin.share_right)});
  }
  return table;
}

Table sweep_table(const BenchLocalizeResult& result, const Sweep& sweep) {
  Table table = points_table("Sweep of " + sweep.name, sweep.quantity);
  for (std::size_t k = 0; k < sweep.values.size(); ++k) {
    for (std::size_t i = 0; i < result.methods.size(); ++i) {
      table.rows.push_back(
          point_row(fmt::format("{:g} {}", sweep.values[k], result.methods[i].name), sweep.points[i][k]));
    }
  }
  return table;
}

std::vector<Table> tables_of(const BenchLocalizeResult& result) {
  std::vector<Table> tables{targets_table(result),
                            scene_table(result, "One marker above the camera", result.centred),
                            scene_table(result, "One marker 0.7 m aside", result.off_axis),
                            scene_table(result, "Three markers in view", result.three),
                            megapixel_table(result),
                            counts_table(result),
                            ceilings_table(result),
                            reliability_table(result),
                            consistency_table(result)};
  if (!result.tried.empty()) tables.push_back(tried_table(result));
  return tables;
}

/// One curve per method, and the bound.
using ValueOf = double (*)(const ScenePoint& point);

std::string sweep_chart(const BenchLocalizeResult& result, const Sweep& sweep, const std::string& title,
                        const std::string& unit, ValueOf value_of, ValueOf bound_of, bool logarithmic) {
  constexpr std::array classes{"a", "b", "c"};
  std::vector<PlotSeries> series;
  const auto add = [&](const std::string& name, const std::string& css_class, std::size_t method,
                       ValueOf value) {
    PlotSeries& curve = series.emplace_back(PlotSeries{name, css_class, {}, false});
    for (std::size_t k = 0; k < sweep.values.size(); ++k)
      curve.points.emplace_back(sweep.values[k], value(sweep.points[method][k]));
  };
  for (std::size_t i = 0; i < result.methods.size(); ++i)
    add(result.methods[i].name, classes.at(i % classes.size()), i, value_of);
  if (bound_of != nullptr) add("bound of our dots", "bound", 0, bound_of);
  return plot_svg(title, unit, series, {sweep.quantity, logarithmic});
}

std::string sweep_charts(const BenchLocalizeResult& result, const Sweep& sweep) {
  const auto chart = [&](const std::string& title, const std::string& unit, ValueOf value, ValueOf bound,
                         bool logarithmic) {
    return sweep_chart(result, sweep, title, unit, value, bound, logarithmic);
  };
  std::string html = chart(
      "Lateral error, tilt known", "mm, RMS",
      [](const ScenePoint& p) { return mm_per_m * p.upright.lateral_m; },
      [](const ScenePoint& p) { return mm_per_m * p.upright_bound.lateral_m; }, true);
  html += chart(
      "Height error, tilt known", "mm, RMS",
      [](const ScenePoint& p) { return mm_per_m * p.upright.height_m; },
      [](const ScenePoint& p) { return mm_per_m * p.upright_bound.height_m; }, true);
  html += chart(
      "Yaw error, tilt known", "degrees, RMS", [](const ScenePoint& p) { return degrees(p.upright.yaw_rad); },
      [](const ScenePoint& p) { return degrees(p.upright_bound.yaw_rad); }, true);
  html +=
      chart("Markers read", "%", [](const ScenePoint& p) { return 100.0 * p.share_read(); }, nullptr, false);
  html += chart(
      "Time from frame to pose", "us, median", [](const ScenePoint& p) { return p.median_us; }, nullptr,
      true);
  return html;
}

std::string lead_of(const BenchLocalizeResult& result) {
  std::string methods;
  for (const MethodChoice& method : result.methods) {
    if (!methods.empty()) methods += "; ";
    methods += fmt::format("{} ({})", method.name, method.settings);
  }
  for (const std::string& peer : result.left_out) methods += fmt::format("; {} left out: not built in", peer);
  return fmt::format(
      "Seed {}, {} frames a point, {} hard frames of each kind, one thread. Our marker is 14 cm wide from "
      "edge to edge of its dots, and so is the black square of each tag. Methods: {}.",
      result.options.seed, result.options.trials, result.options.frames, methods);
}

}  // namespace

std::string bench_localize_text(const BenchLocalizeResult& result) {
  std::string text = lead_of(result) + "\n";
  for (const Table& table : tables_of(result)) text += fmt::format("\n{}", text_of(table));
  for (const Sweep& sweep : result.sweeps) text += fmt::format("\n{}", text_of(sweep_table(result, sweep)));
  return text;
}

std::string bench_localize_html(const BenchLocalizeResult& result) {
  std::string body =
      fmt::format("<h1>Localization</h1>\n<p class=\"lead\">{}</p>\n", escaped(lead_of(result)));
  for (const Table& table : tables_of(result)) body += html_of(table);
  for (const Sweep& sweep : result.sweeps)
    body += html_of(sweep_table(result, sweep)) + sweep_charts(result, sweep);
  return page_html("Lodestar: localization", body);
}

}  // namespace lodestar
