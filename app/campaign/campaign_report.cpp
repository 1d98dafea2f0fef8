#include "app/campaign/campaign_report.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <map>

#include "app/report/page.hpp"
#include "app/report/plot.hpp"
#include "maps/percentile.hpp"

namespace lodestar {
namespace {

using Json = nlohmann::ordered_json;

constexpr double ms_per_s = 1000.0;

/// Statistics of all missions, or of those with one kind of fault.
struct Tally {
  int missions = 0;
  int arrivals = 0;
  int safe_stops = 0;
  int contacts = 0;
  int excused = 0;  ///< missions with a contact that nothing on board could have prevented
  int silently_wrong = 0;
  std::map<std::string, int> reasons;  ///< of the safe stops
  std::vector<double> noticed_after_s;
  std::vector<double> stopped_within_m;
  std::vector<double> errors_m;          ///< at arrivals
  std::optional<PeopleContacts> people;  ///< sums, and the fastest

  void add(const MissionOutcome& outcome) {
    ++missions;
    contacts += outcome.hit_something() ? 1 : 0;
    excused += outcome.is_excused() ? 1 : 0;
    silently_wrong += outcome.silently_wrong() ? 1 : 0;
    arrivals += outcome.arrived && !outcome.silently_wrong() && !outcome.is_excused() ? 1 : 0;
    if (outcome.arrived) errors_m.push_back(outcome.error_m);
    if (!outcome.arrived && !outcome.hit_something() && !outcome.is_excused()) {
      ++safe_stops;
      ++reasons[outcome.failure];
    }
    if (outcome.people) {
      if (!people) people.emplace();
      people->moving += outcome.people->moving;
      people->excused += outcome.people->excused;
      people->at_rest += outcome.people->at_rest;
      people->greatest_mps = std::max(people->greatest_mps, outcome.people->greatest_mps);
    }
    if (outcome.noticed_after_s) noticed_after_s.push_back(*outcome.noticed_after_s);
    if (outcome.stopped_within_m) stopped_within_m.push_back(*outcome.stopped_within_m);
  }
};

/// By kind of fault. A mission with several counts for each of them, one without a fault under "none".
std::map<std::string, Tally> by_fault(const std::vector<MissionOutcome>& outcomes) {
  std::map<std::string, Tally> tallies;
  for (const MissionOutcome& outcome : outcomes) {
    if (outcome.faults.empty()) tallies["none"].add(outcome);
    std::vector<std::string> kinds = outcome.faults;
    std::ranges::sort(kinds);
    kinds.erase(std::ranges::unique(kinds).begin(), kinds.end());
    for (const std::string& kind : kinds) tallies[kind].add(outcome);
  }
  return tallies;
}

Tally all_of(const std::vector<MissionOutcome>& outcomes) {
  Tally tally;
  for (const MissionOutcome& outcome : outcomes) tally.add(outcome);
  return tally;
}

Json spread(const std::vector<double>& values) {
  const auto at = [&](double share) {
    const std::optional<double> value = percentile(values, share);
    return value ? Json(*value) : Json(nullptr);
  };
  return {{"count", values.size()}, {"p50", at(0.5)}, {"p99", at(0.99)}, {"max", at(1.0)}};
}

Json as_json(const Tally& tally) {
  Json json{{"missions", tally.missions},
            {"arrivals", tally.arrivals},
            {"safe_stops", tally.safe_stops},
            {"contacts", tally.contacts},
            {"excused", tally.excused},
            {"silently_wrong", tally.silently_wrong},
            {"reasons", tally.reasons},
            {"error_m", spread(tally.errors_m)},
            {"noticed_after_s", spread(tally.noticed_after_s)},
            {"stopped_within_m", spread(tally.stopped_within_m)}};
  if (tally.people) {
    json["people"] = {{"moving", tally.people->moving},
                      {"excused", tally.people->excused},
                      {"at_rest", tally.people->at_rest},
                      {"greatest_mps", tally.people->greatest_mps}};
  }
  return json;
}

std::vector<MissionOutcome> those_that(bool (MissionOutcome::*is_such)() const,
                                       const std::vector<MissionOutcome>& outcomes) {
  std::vector<MissionOutcome> such;
  std::ranges::copy_if(outcomes, std::back_inserter(such), is_such);
  return such;
}

Json listed(const std::vector<MissionOutcome>& outcomes) {
  Json list = Json::array();
  for (const MissionOutcome& outcome : outcomes) {
    Json entry = lodestar::as_json(outcome);
    entry["repeat"] = repeat_command(outcome);
    list.push_back(std::move(entry));
  }
  return list;
}

std::string cell(const std::vector<double>& values, double share, double factor) {
  const std::optional<double> value = percentile(values, share);
  return value ? fmt::format("<td>{:.0f}</td>", factor * *value) : "<td></td>";
}

std::string people_cells(const Tally& tally) {
  if (!tally.people) return {};
  return fmt::format("<td>{}</td><td>{}</td><td>{}</td>", tally.people->moving, tally.people->excused,
                     tally.people->at_rest);
}

std::string row_of(const std::string& name, const Tally& tally) {
  return fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>", escaped(name),
                     tally.missions, tally.arrivals, tally.safe_stops, tally.contacts, tally.silently_wrong) +
         cell(tally.noticed_after_s, 0.5, ms_per_s) + cell(tally.noticed_after_s, 0.99, ms_per_s) +
         cell(tally.noticed_after_s, 1.0, ms_per_s) + cell(tally.stopped_within_m, 0.99, mm_per_m) +
         cell(tally.errors_m, 0.99, mm_per_m) + cell(tally.errors_m, 1.0, mm_per_m) + people_cells(tally) +
         "</tr>\n";
}

}  // namespace

std::string repeat_command(const MissionOutcome& outcome) {
  return fmt::format("lodestar campaign --mission {}{}{}", outcome.mission, outcome.people ? " --people" : "",
                     outcome.spared ? " --no-faults" : "");
}

Json campaign_json(const std::vector<MissionOutcome>& outcomes) {
  Json faults = Json::object();
  for (const auto& [kind, tally] : by_fault(outcomes)) faults[kind] = as_json(tally);
  return {{"all", as_json(all_of(outcomes))},
          {"by_fault", faults},
          {"failures", listed(those_that(&MissionOutcome::has_failed, outcomes))},
          {"excused", listed(those_that(&MissionOutcome::is_excused, outcomes))}};
}

std::string campaign_html(const std::vector<MissionOutcome>& outcomes) {
  const Tally all = all_of(outcomes);
  std::string html = fmt::format(
      "<h1>Fault campaign</h1>\n<p class=\"lead\">{} missions: {} arrivals, {} safe stops, {} with contacts, "
      "{} with an excused one, {} silently "
      "wrong.</p>\n<table><tr><th>Fault</th><th>Missions</th><th>Arrived</th><th>Stopped "
      "safely</th><th>Contacts</th><th>Silently wrong</th><th>Noticed after, ms: "
      "median</th><th>p99</th><th>max</th><th>Stopped within, mm: p99</th><th>Position error at the goal, "
      "mm: p99</th><th>max</th>{}</tr>\n",
      all.missions, all.arrivals, all.safe_stops, all.contacts, all.excused, all.silently_wrong,
      all.people ? "<th>Contacts with people: moving</th><th>excused</th><th>at rest</th>" : "");
  html += row_of("all", all);
  for (const auto& [kind, tally] : by_fault(outcomes)) html += row_of(kind, tally);
  html += "</table>\n<h2>Why it stopped</h2>\n<table><tr><th>Reason</th><th>Missions</th></tr>\n";
  for (const auto& [reason, count] : all.reasons)
    html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(reason), count);
  html += "</table>\n";
  std::string rows;
  const auto append_row = [&](const MissionOutcome& outcome) {
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td><code>{}</code></td></tr>\n",
                        escaped(outcome.what_happened()), fmt::join(outcome.faults, ", "),
                        repeat_command(outcome));
  };
  for (const MissionOutcome& outcome : those_that(&MissionOutcome::has_failed, outcomes)) append_row(outcome);
  for (const MissionOutcome& outcome : those_that(&MissionOutcome::is_excused, outcomes)) append_row(outcome);
  if (rows.empty()) return page_html("Lodestar: fault campaign", html);
  html += "<h2>Failures</h2>\n<table><tr><th>What</th><th>Faults</th><th>Repeat with</th></tr>\n";
  return page_html("Lodestar: fault campaign", html + rows + "</table>\n");
}

}  // namespace lodestar
