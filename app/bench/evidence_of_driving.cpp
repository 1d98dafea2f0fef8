#include <cstdio>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "app/bench/evidence_readers.hpp"

namespace lodestar {
namespace {

using Json = nlohmann::json;

// DESIGN, "Numbers to reach".
constexpr double most_plan_ms_99 = 10.0;
constexpr double most_plan_ms = 50.0;
constexpr double most_over_best_time = 1.01;
constexpr double most_scan_us = 500.0;

double ms(const Json& microseconds) {
  return 1e-3 * microseconds.get<double>();
}

const Json& planner_named(const Json& planners, const std::string& name) {
  for (const Json& each : planners)
    if (each.at("planner") == name) return each;
  throw std::runtime_error("no planner " + name);
}

/// CPU time, which others on the machine disturb least.
double cpu_us(const Json& benchmark) {
  const std::string unit = benchmark.at("time_unit");
  const double scale = unit == "ns" ? 1e-3 : unit == "us" ? 1.0 : unit == "ms" ? 1e3 : 1e6;
  return scale * benchmark.at("cpu_time").get<double>();
}

}  // namespace

std::vector<EvidenceRow> octile_rows(const std::string& output) {
  const Json json = Json::parse(output);
  EvidenceRow optimal =
      at_least("queries answered with the optimal length", json.at("optimal"), json.at("queries"), "");
  EvidenceRow time =
      at_most("time over that of plain A* with a binary heap, medians",
              json.at("median_us").get<double>() / json.at("plain_astar_median_us").get<double>(), 1.0, "x");
  time.peer = fmt::format("{:.0f} us against our {:.2f} us", json.at("plain_astar_median_us").get<double>(),
                          json.at("median_us").get<double>());
  return {optimal, time};
}

std::vector<EvidenceRow> map_rows(const std::string& output) {
  const Json json = Json::parse(output);
  const Json& plan = json.at("plan_us");
  EvidenceRow ratio = at_most("travel time over the best known, 99 %", json.at("travel_time_ratio").at("p99"),
                              most_over_best_time, "x");
  ratio.peer = "best of forty times the work, anyangle and astar";
  return {at_least("queries with a path", json.at("found"), json.at("queries"), ""),
          at_most("time of a plan, 99 %", ms(plan.at("p99")), most_plan_ms_99, "ms"),
          at_most("time of a plan, longest", ms(plan.at("max")), most_plan_ms, "ms"), ratio};
}

std::vector<EvidenceRow> site_rows(const std::string& output) {
  const Json json = Json::parse(output);
  const Json& ours = planner_named(json.at("planners"), "fastest");
  EvidenceRow time{.what = "time of a plan by the default planner, median",
                   .today = fmt::format("{:.3g} ms", ms(ours.at("median_us")))};
  EvidenceRow ratio = at_most("travel time over the best path of all planners, median",
                              ours.at("travel_time_ratio"), most_over_best_time, "x");
  for (const Json& each : json.at("planners")) {
    const std::string name = each.at("planner");
    if (name == "fastest") continue;
    const char* const comma = time.peer.empty() ? "" : ", ";
    time.peer += fmt::format("{}{} {:.3g} ms", comma, name, ms(each.at("median_us")));
    ratio.peer += fmt::format("{}{} {:.3f}", comma, name, each.at("travel_time_ratio").get<double>());
  }
  return {time, ratio};
}

std::vector<EvidenceRow> campaign_rows(const std::string& output) {
  int missions = 0;
  int arrivals = 0;
  int safe_stops = 0;
  int contacts = 0;
  int wrong = 0;
  std::vector<EvidenceRow> rows;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    int moving = 0;
    int excused = 0;
    // NOLINTNEXTLINE(cert-err34-c): what does not fit is not counted as a match
    if (std::sscanf(line.c_str(),
                    "%d missions: %d arrivals, %d safe stops, %d with contacts, %d silently wrong", &missions,
                    &arrivals, &safe_stops, &contacts, &wrong) == 5) {
      rows.push_back(at_most("missions with a contact", contacts, 0.0, ""));
      rows.push_back(at_most("missions that arrived silently wrong", wrong, 0.0, ""));
      rows.push_back({.what = "missions that arrived; the others stopped",
                      .today = fmt::format("{} of {}", arrivals, missions)});
    } else if (line.find(" with an excused contact") != std::string::npos) {
      rows.push_back({.what = "missions with a contact whose cause nothing on board could show",
                      .today = line.substr(0, line.find(' '))});
      // NOLINTNEXTLINE(cert-err34-c)
    } else if (std::sscanf(line.c_str(), "contacts with people: %d while moving, %d excused", &moving,
                           &excused) == 2) {
      rows.push_back(at_most("contacts with people while the robot moved", moving, 0.0, ""));
      rows.push_back({.what = "the same, excused: faster than 2 m/s, or in sight too late",
                      .today = fmt::format("{}", excused)});
    }
  }
  return rows;
}

std::vector<EvidenceRow> scenario_rows(const std::string& output) {
  int runs = 0;
  int successes = 0;
  int moving = 0;
  int at_rest = 0;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    const Json run = Json::parse(line);
    ++runs;
    successes += run.at("success").get<bool>() ? 1 : 0;
    moving += run.at("contacts_moving").get<int>();
    at_rest += run.at("contacts_at_rest").get<int>();
  }
  return {at_least("runs that arrive", successes, runs, ""),
          at_most("contacts while the robot moved", moving, 0.0, ""),
          {.what = "people who walked into the standing robot", .today = fmt::format("{}", at_rest)}};
}

std::vector<EvidenceRow> scan_rows(const std::string& output) {
  const Json json = Json::parse(output);
  std::vector<EvidenceRow> rows;
  for (const Json& each : json.at("benchmarks"))
    rows.push_back(
        at_most(each.at("name").get<std::string>() + ", CPU time", cpu_us(each), most_scan_us, "us"));
  return rows;
}

std::vector<EvidenceRow> timing_rows(const std::string& output) {
  const Json json = Json::parse(output);
  std::vector<EvidenceRow> rows;
  for (const Json& each : json.at("benchmarks"))
    rows.push_back({.what = each.at("name").get<std::string>() + ", CPU time",
                    .today = fmt::format("{:.4g} us", cpu_us(each))});
  return rows;
}

}  // namespace lodestar
