#include "app/bench/localize_report.hpp"

namespace lodestar {
namespace {

using Json = nlohmann::ordered_json;

Json spread_json(const PoseSpread& rms, const PoseSpread& bound) {
  const auto ratio = [](double value, double least) { return least > 0.0 ? Json(value / least) : Json(); };
  return {{"poses", rms.poses},
          {"lateral_rms_mm", mm_per_m * rms.lateral_m},
          {"height_rms_mm", mm_per_m * rms.height_m},
          {"yaw_rms_deg", degrees(rms.yaw_rad)},
          {"lateral_bound_mm", mm_per_m * bound.lateral_m},
          {"height_bound_mm", mm_per_m * bound.height_m},
          {"yaw_bound_deg", degrees(bound.yaw_rad)},
          {"lateral_over_bound", ratio(rms.lateral_m, bound.lateral_m)},
          {"height_over_bound", ratio(rms.height_m, bound.height_m)},
          {"yaw_over_bound", ratio(rms.yaw_rad, bound.yaw_rad)}};
}

Json point_json(const ScenePoint& point) {
  return {{"markers", point.markers},
          {"read", point.read},
          {"wrong", point.wrong},
          {"median_us", point.median_us},
          {"threshold_us", point.threshold_us},
          {"tilt_known", spread_json(point.upright, point.upright_bound)},
          {"tilt_free", spread_json(point.free, point.free_bound)}};
}

Json points_json(const BenchLocalizeResult& result, const std::vector<ScenePoint>& points) {
  Json json = Json::object();
  for (std::size_t i = 0; i < points.size(); ++i) json[result.methods[i].name] = point_json(points[i]);
  return json;
}

Json counts_json(const FrameCounts& counts) {
  Json bins = Json::array();
  for (const ReliabilityBin& bin : reliability(counts.stated)) {
    bins.push_back({{"low", bin.low},
                    {"high", bin.high},
                    {"readings", bin.count},
                    {"mean_stated", bin.mean_stated},
                    {"share_right", bin.share_right}});
  }
  return {{"frames", counts.frames},
          {"markers_in_full_view", counts.markers},
          {"read_in_full_view", counts.read},
          {"read_right", counts.right},
          {"read_wrong", counts.wrong},
          {"frames_with_wrong", counts.frames_with_wrong},
          {"reliability", bins}};
}

Json sweep_json(const BenchLocalizeResult& result, const Sweep& sweep) {
  Json methods = Json::object();
  for (std::size_t i = 0; i < result.methods.size(); ++i) {
    Json& rows = methods[result.methods[i].name] = Json::array();
    for (std::size_t k = 0; k < sweep.values.size(); ++k) {
      Json row{{"value", sweep.values[k]}};
      row.update(point_json(sweep.points[i][k]));
      rows.push_back(row);
    }
  }
  return {{"sweep", sweep.name}, {"quantity", sweep.quantity}, {"methods", methods}};
}

}  // namespace

Json bench_localize_json(const BenchLocalizeResult& result) {
  Json json{{"seed", result.options.seed},     {"trials", result.options.trials},
            {"frames", result.options.frames}, {"methods", Json::array()},
            {"left_out", result.left_out},     {"targets", Json::array()}};
  for (const MethodChoice& method : result.methods)
    json["methods"].push_back({{"name", method.name}, {"settings", method.settings}});
  for (const Target& target : result.targets) {
    json["targets"].push_back({{"name", target.name},
                               {"value", target.value},
                               {target.at_least ? "at_least" : "at_most", target.limit},
                               {"unit", target.unit},
                               {"reached", target.reached()}});
  }
  json["centred"] = points_json(result, result.centred);
  json["off_axis"] = points_json(result, result.off_axis);
  json["three_markers"] = points_json(result, result.three);
  for (const MethodCounts& counts : result.counts) {
    json["hard_frames"][counts.method] = {{"adverse", counts_json(counts.adverse)},
                                          {"empty", counts_json(counts.empty)},
                                          {"direction_dot_lost", counts_json(counts.direction_dot_lost)}};
  }
  json["megapixel"] = point_json(result.megapixel);
  for (const CeilingCounts& row : result.ceilings) json["ceilings"][row.name] = counts_json(row.counts);
  json["consistency"] = Json::array();
  for (const Consistency& one : result.consistency) {
    json["consistency"].push_back({{"conditions", one.conditions},
                                   {"frames", one.frames},
                                   {"poses", one.poses},
                                   {"degrees_of_freedom", one.degrees_of_freedom},
                                   {"mean_nees_per_degree", one.per_degree()},
                                   {"half_band_per_degree", one.half_band_per_degree()}});
  }
  json["settings_tried"] = Json::array();
  for (const TriedSettings& tried : result.tried) {
    Json row{{"name", tried.choice.name}, {"settings", tried.choice.settings}};
    row.update(point_json(tried.point));
    json["settings_tried"].push_back(row);
  }
  json["sweeps"] = Json::array();
  for (const Sweep& sweep : result.sweeps) json["sweeps"].push_back(sweep_json(result, sweep));
  return json;
}

}  // namespace lodestar
