#include "app/placement/camera_set.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/placement/board_choice.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// A number of the fit with its standard deviation.
struct Intrinsic {
  const char* name;
  double value;
  double sigma;
};

std::vector<Intrinsic> intrinsics_of(const LensFit& fit) {
  const CameraModel& camera = fit.camera;
  std::vector<Intrinsic> all{{"fx_px", camera.fx_px, fit.sigmas.fx_px},
                             {"fy_px", camera.fy_px, fit.sigmas.fy_px},
                             {"cx_px", camera.cx_px, fit.sigmas.cx_px},
                             {"cy_px", camera.cy_px, fit.sigmas.cy_px}};
  std::vector<const char*> names{"k1", "k2", "p1", "p2", "k3"};
  if (camera.distortion == Distortion::rational_polynomial) names.insert(names.end(), {"k4", "k5", "k6"});
  if (camera.distortion == Distortion::equidistant) names = {"k1", "k2", "k3", "k4"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    all.push_back({names[i], camera.coefficients[i], fit.sigmas.coefficients[i]});
  }
  return all;
}

std::string picture_of(const Coverage& coverage) {
  std::string picture;
  for (std::size_t i = 0; i < coverage.cells.size(); ++i) {
    if (i % Coverage::columns == 0) picture += "  ";
    picture += coverage.cells[i] ? '#' : '.';
    if ((i + 1) % Coverage::columns == 0) picture += '\n';
  }
  return picture;
}

std::vector<std::string> outlier_names(const CameraSet& set, const CameraCalibration& calibration) {
  std::vector<std::string> names;
  for (const std::size_t index : calibration.outliers) names.push_back(set.files[index]);
  return names;
}

std::string complaint(CameraFlaw flaw, const CameraSet& set, const CameraCalibration& calibration,
                      const CameraCalibrationOptions& options) {
  switch (flaw) {
    case CameraFlaw::too_few_boards:
      return fmt::format("found the board in {} of {} images, wanted at least {}", set.views.size(),
                         set.views.size() + set.files_without_board.size(), options.least_boards);
    case CameraFlaw::one_orientation:
      return fmt::format(
          "found boards of nearly one orientation (spread of {:.1f} deg), wanted at least {:.1f} deg: "
          "tilt the board to all sides",
          degrees(calibration.tilt_spread_rad), degrees(options.least_tilt_spread_rad));
    case CameraFlaw::poor_coverage:
      return fmt::format(
          "found corners in {:.0f} % of the image, wanted at least {:.0f} %: bring the board to "
          "the parts that the picture shows empty",
          100.0 * calibration.coverage.share(), 100.0 * options.least_coverage);
    case CameraFlaw::large_error:
      return fmt::format(
          "found a reprojection error of {:.2f} px, wanted at most {:.2f} px: is the board flat, the "
          "image sharp, the model right for this lens?",
          calibration.fit->all_rms_px, options.most_rms_px);
    case CameraFlaw::outlier_views:
      return fmt::format("found images that fit far worse than the others, take them out: {}",
                         fmt::join(outlier_names(set, calibration), " "));
    case CameraFlaw::undetermined:
      return fmt::format(
          "found no camera, or one that these images hardly determine; wanted focal lengths to {:.1f} "
          "%: more images with the board tilted to all sides",
          100.0 * options.most_focal_sigma);
  }
  return "";
}

/// JSON has no NaN and no infinity.
nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

CameraSet read_camera_set(FrameSource& frames, const CalibrationBoard& board,
                          const std::function<void(const CameraSet& so_far)>& taken) {
  constexpr std::size_t enough_of_sequence = 30;
  CameraSet set;
  std::optional<BoardChoice> choice;
  std::string first;
  while (const std::optional<SourceFrame> image = frames.next()) {
    if (first.empty()) {
      first = image->name;
      set.width_px = image->gray.cols;
      set.height_px = image->gray.rows;
      choice.emplace(set.width_px);
    }
    if (image->gray.cols != set.width_px || image->gray.rows != set.height_px) {
      throw InputError(image->name, 0, fmt::format("{} x {} pixels", image->gray.cols, image->gray.rows),
                       fmt::format("{} x {} as in {}", set.width_px, set.height_px, first));
    }
    std::optional<BoardView> view = find_board(image->gray, board);
    if (image->of_sequence && !choice->takes(view)) continue;
    if (!view) {
      set.files_without_board.push_back(image->name);
      continue;
    }
    set.files.push_back(image->name);
    set.views.push_back(std::move(*view));
    if (!image->of_sequence) continue;
    taken(set);
    if (set.views.size() >= enough_of_sequence) break;
  }
  return set;
}

std::string text_report(const CameraSet& set, const CameraCalibration& calibration) {
  std::string text;
  for (std::size_t i = 0; calibration.fit && i < set.files.size(); ++i) {
    text += fmt::format("{}: {} corners, {:.3f} px\n", set.files[i], set.views[i].pixels.size(),
                        calibration.fit->rms_px[i]);
  }
  for (const std::string& file : set.files_without_board) text += fmt::format("{}: no board\n", file);
  text += fmt::format("coverage {:.0f} %\n{}", 100.0 * calibration.coverage.share(),
                      picture_of(calibration.coverage));
  if (!calibration.fit) return text;
  text += fmt::format("spread of the boards' tilts {:.1f} deg\n", degrees(calibration.tilt_spread_rad));
  text += fmt::format("reprojection error {:.3f} px\n", calibration.fit->all_rms_px);
  for (const Intrinsic& number : intrinsics_of(*calibration.fit)) {
    text += fmt::format("{:<6} {:>12.6g}  +- {:.2g}\n", number.name, number.value, number.sigma);
  }
  return text;
}

nlohmann::ordered_json json_report(const CameraSet& set, const CameraCalibration& calibration) {
  nlohmann::ordered_json report{{"width_px", set.width_px},
                                {"height_px", set.height_px},
                                {"usable", calibration.flaws.empty()},
                                {"flaws", nlohmann::ordered_json::array()},
                                {"images", nlohmann::ordered_json::array()},
                                {"images_without_board", set.files_without_board},
                                {"outliers", outlier_names(set, calibration)},
                                {"coverage", calibration.coverage.share()}};
  for (const CameraFlaw flaw : calibration.flaws) report["flaws"].push_back(to_string(flaw));
  for (std::size_t i = 0; i < set.files.size(); ++i) {
    nlohmann::ordered_json image{{"file", set.files[i]}, {"corners", set.views[i].pixels.size()}};
    if (calibration.fit) image["rms_px"] = calibration.fit->rms_px[i];
    report["images"].push_back(std::move(image));
  }
  if (!calibration.fit) return report;
  report["tilt_spread_deg"] = degrees(calibration.tilt_spread_rad);
  report["rms_px"] = calibration.fit->all_rms_px;
  for (const Intrinsic& number : intrinsics_of(*calibration.fit)) {
    report["intrinsics"][number.name] = number.value;
    report["sigmas"][number.name] = number_or_null(number.sigma);
  }
  return report;
}

std::vector<std::string> complaints(const CameraSet& set, const CameraCalibration& calibration,
                                    const CameraCalibrationOptions& options) {
  std::vector<std::string> lines;
  for (const CameraFlaw flaw : calibration.flaws) {
    lines.push_back(fmt::format("{}: {}", to_string(flaw), complaint(flaw, set, calibration, options)));
  }
  return lines;
}

}  // namespace lodestar
