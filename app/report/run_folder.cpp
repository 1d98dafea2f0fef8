#include "app/report/run_folder.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/common/json_text.hpp"
#include "app/placement/survey_report.hpp"
#include "app/report/figure.hpp"
#include "app/report/report.hpp"
#include "app/report/run_statistics.hpp"
#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"
#include "maps/picture.hpp"

namespace lodestar {
namespace {

/// TUM: stamp, position, quaternion with w last, single spaces.
void append_tum(std::string& text, Stamp stamp, const Pose2& pose) {
  text += fmt::format("{:.9f} {:.6f} {:.6f} 0.000000 0.000000000 0.000000000 {:.9f} {:.9f}\n", seconds(stamp),
                      pose.position_m.x(), pose.position_m.y(), std::sin(0.5 * pose.yaw_rad),
                      std::cos(0.5 * pose.yaw_rad));
}

/// Steps between two wheel readings repeat an estimate; a trajectory's stamps must ascend.
std::string estimate_tum(const RunRecord& record) {
  std::string text;
  std::optional<Stamp> last;
  for (const StepRecord& step : record.steps) {
    if (last && step.estimate.stamp <= *last) continue;
    append_tum(text, step.estimate.stamp, step.estimate.map_from_base);
    last = step.estimate.stamp;
  }
  return text;
}

std::string truth_tum(const RunRecord& record) {
  std::string text;
  for (const TruePose& pose : record.truth) append_tum(text, pose.stamp, pose.map_from_base);
  return text;
}

std::string steps_csv(const RunRecord& record) {
  std::string text =
      "stamp_s,x_m,y_m,yaw_deg,sigma_m,sigma_yaw_deg,commanded_mps,commanded_degps,driven_mps,driven_degps,"
      "xx_m2,xy_m2,yy_m2\n";
  for (const StepRecord& step : record.steps) {
    const Pose2& pose = step.estimate.map_from_base;
    const Eigen::Matrix3d& covariance = step.estimate.covariance;
    text += fmt::format(
        "{:.4f},{:.5f},{:.5f},{:.3f},{:.6f},{:.4f},{:.4f},{:.3f},{:.4f},{:.3f},{:.4g},{:.4g},{:.4g}\n",
        seconds(step.estimate.stamp), pose.position_m.x(), pose.position_m.y(), degrees(pose.yaw_rad),
        larger_sigma(covariance.topLeftCorner<2, 2>()), degrees(std::sqrt(covariance(2, 2))),
        step.commanded.forward_mps, degrees(step.commanded.turn_radps), step.measured.forward_mps,
        degrees(step.measured.turn_radps), covariance(0, 0), covariance(0, 1), covariance(1, 1));
  }
  return text;
}

std::string fixes_csv(const RunRecord& record) {
  std::string text = "stamp_s,x_m,y_m,yaw_deg,confidence,accepted,ids\n";
  for (const FixRecord& fix : record.fixes) {
    const Pose2& pose = fix.map_from_base;
    text += fmt::format("{:.4f},{:.5f},{:.5f},{:.3f},{:.4f},{},{}\n", seconds(fix.stamp), pose.position_m.x(),
                        pose.position_m.y(), degrees(pose.yaw_rad), fix.confidence, fix.accepted ? 1 : 0,
                        fmt::join(fix.ids, "+"));
  }
  return text;
}

/// A real drive has none; nor does it keep that of a drive that left its folder here before.
void write_truth(const std::filesystem::path& file, const RunRecord& record) {
  if (!record.truth.empty()) return write_file_atomically(file, truth_tum(record));
  std::error_code none;
  std::filesystem::remove(file, none);
}

/// What `survey check` would propose of the markers that the robot ended up distrusting; offsets in the
/// registry's frame. No file where it trusts all.
void write_proposals(const std::filesystem::path& file, const RunRecord& record,
                     const MarkerRegistry& registry) {
  if (record.distrusted.empty()) {
    std::error_code none;
    std::filesystem::remove(file, none);
    return;
  }
  SurveyDifference found;
  const Eigen::Rotation2Dd registry_from_map(-registry.map_from_registry.yaw_rad);
  for (const DistrustedMarker& marker : record.distrusted)
    found.proposals.push_back({.id = marker.id,
                               .change = MarkerChange::moved,
                               .offset_m = registry_from_map * marker.offset_m,
                               .turn_rad = marker.turn_rad,
                               .sigma_m = marker.sigma_m,
                               .sigma_rad = marker.sigma_rad});
  write_file_atomically(file, csv_report(found));
}

void write_pictures(const std::filesystem::path& folder, const RunRecord& record) {
  if (record.pictures.empty()) return;
  make_run_folder(folder);
  for (const KeptPicture& picture : record.pictures) {
    const std::string& jpeg = picture.jpeg.get();
    if (jpeg.empty()) continue;
    write_file_atomically(folder / fmt::format("{:.3f}.jpg", seconds(picture.stamp)), jpeg);
  }
}

}  // namespace

void make_run_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError(folder, 0, "a folder that could not be made (" + error.message() + ")", "one that can");
}

void write_run_folder(const std::filesystem::path& folder, const RunRecord& record, const OccupancyMap& map,
                      const MarkerRegistry& registry, const Places& places) {
  make_run_folder(folder);
  const std::string picture = png_bytes(draw_experiment(record, map, registry, places));
  write_file_atomically(folder / "map.png", picture);
  write_file_atomically(folder / "estimate.tum", estimate_tum(record));
  write_truth(folder / "truth.tum", record);
  write_file_atomically(folder / "steps.csv", steps_csv(record));
  write_file_atomically(folder / "fixes.csv", fixes_csv(record));
  // Those who wait for it may read what is above.
  write_file_atomically(folder / "summary.json", json_document(summary_of(record)));
  write_proposals(folder / "proposals.csv", record, registry);
  write_pictures(folder / "pictures", record);
  write_file_atomically(folder / "report.html", report_html(record, picture));
}

}  // namespace lodestar
