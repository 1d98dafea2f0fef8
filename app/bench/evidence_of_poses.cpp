#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/bench/evidence_readers.hpp"

namespace lodestar {
namespace {

using Json = nlohmann::json;

EvidenceRow target_row(const Json& target) {
  const bool has_minimum = target.contains("at_least");
  const auto judged = has_minimum ? at_least : at_most;
  return judged(target.at("name"), target.at("value"), target.at(has_minimum ? "at_least" : "at_most"),
                target.at("unit"));
}

/// A figure of the first method, ours, and beside it that of all others.
EvidenceRow beside_peers(const std::string& what, const Json& methods,
                         const std::function<std::string(const Json& method)>& figure) {
  EvidenceRow row{.what = what};
  for (const auto& [name, method] : methods.items()) {
    if (name == "lodestar") {
      row.today = figure(method);
    } else {
      row.peer += fmt::format("{}{} {}", row.peer.empty() ? "" : ", ", name, figure(method));
    }
  }
  return row;
}

std::string pose_time(const Json& method) {
  return fmt::format("{:.0f} us", method.at("median_us").get<double>());
}

std::string lateral(const Json& method) {
  return fmt::format("{:.3f} mm", method.at("tilt_known").at("lateral_rms_mm").get<double>());
}

std::string share_read(const Json& method) {
  const Json& counts = method.at("adverse");
  return fmt::format("{} of {}, {} wrong", counts.at("read_right").get<int>(),
                     counts.at("markers_in_full_view").get<int>(), counts.at("read_wrong").get<int>());
}

EvidenceRow consistency_row(const Json& one) {
  const double nees = one.at("mean_nees_per_degree");
  const double half_band = one.at("half_band_per_degree");
  return {.what = fmt::format("errors match the covariance (NEES per degree of freedom), {}",
                              one.at("conditions").get<std::string>()),
          .today = fmt::format("{:.3f}", nees),
          .limit = fmt::format("1 within {:.3f}, 95 of 100 times", half_band)};
}

}  // namespace

std::vector<EvidenceRow> localize_rows(const std::string& output) {
  const Json json = Json::parse(output);
  std::vector<EvidenceRow> rows;
  for (const Json& target : json.at("targets")) rows.push_back(target_row(target));
  const Json& three = json.at("three_markers");
  rows.push_back(beside_peers("3 markers, from frame to pose, median", three, pose_time));
  rows.push_back(beside_peers("3 markers, tilt known: lateral RMS", three, lateral));
  rows.push_back(beside_peers("1 marker, tilt known: lateral RMS", json.at("centred"), lateral));
  rows.push_back(beside_peers("hard frames: markers read right", json.at("hard_frames"), share_read));
  for (const Json& peer : json.at("left_out"))
    rows.push_back({.what = fmt::format("beside {}", peer.get<std::string>()),
                    .standing = EvidenceStanding::not_possible,
                    .why = "this program was built without it"});
  for (const Json& one : json.at("consistency")) rows.push_back(consistency_row(one));
  return rows;
}

std::vector<EvidenceRow> paper_rows(const std::string& output) {
  const Json json = Json::parse(output);
  const Json& identified = json.at("table_1");
  const Json& angles = json.at("table_2");
  const Json& positions = json.at("table_3");
  const auto percent_of = [](const Json& counts) {
    return 100.0 * counts.at("correct").get<double>() / counts.at("trials").get<double>();
  };
  EvidenceRow ids = at_least("Table 1: identified; the paper's own figure is the limit",
                             percent_of(identified.at("ours")), percent_of(identified.at("paper")), "%");
  ids.peer = fmt::format("the paper's method {:.4g} %", percent_of(identified.at("papers_method")));
  EvidenceRow angle = at_most("Table 2: mean deviation of the angle", angles.at("mean_abs_deg"),
                              angles.at("paper_mean_abs_deg"), "deg");
  angle.peer =
      fmt::format("the paper's method {:.3g} deg", angles.at("mean_abs_deg_by_papers_method").get<double>());
  EvidenceRow position = at_most("Table 3: mean deviation of the position", positions.at("mean_cm"),
                                 positions.at("paper_mean_cm"), "cm");
  position.peer =
      fmt::format("the paper's method {:.3g} cm", positions.at("mean_cm_by_papers_method").get<double>());
  return {ids, angle, position, at_most("Table 1: wrong IDs", identified.at("ours").at("wrong"), 0.0, "")};
}

std::vector<EvidenceRow> survey_rows(const std::string& output) {
  std::vector<EvidenceRow> rows;
  for (const Json& tour : Json::parse(output)) {
    EvidenceRow row{
        .what = tour.at("scenario"),
        .today = fmt::format("RMS {:.2f} mm, worst {:.2f} mm", 1e3 * tour.at("rms_m").get<double>(),
                             1e3 * tour.at("worst_m").get<double>()),
        .limit = "none broken of those in `bench survey`",
        .peer = fmt::format("Fisher bound {:.2f} mm", 1e3 * tour.at("bound_m").get<double>()),
        .standing = tour.at("broken_limits").empty() ? EvidenceStanding::kept : EvidenceStanding::missed};
    for (const Json& broken : tour.at("broken_limits")) row.today += "; " + broken.get<std::string>();
    rows.push_back(row);
  }
  return rows;
}

std::vector<EvidenceRow> spoiled_rows(const std::string& output) {
  std::vector<EvidenceRow> rows;
  for (const Json& kind : Json::parse(output)) {
    EvidenceRow row =
        at_most(fmt::format("registries silently wrong, {}", kind.at("spoiled").get<std::string>()),
                kind.at("silently_wrong"), 0.0, "");
    row.today +=
        fmt::format(" of {} ({} refused)", kind.at("logs").get<int>(), kind.at("refused").get<int>());
    rows.push_back(row);
  }
  return rows;
}

}  // namespace lodestar
