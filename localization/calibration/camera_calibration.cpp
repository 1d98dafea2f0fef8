#include "localization/calibration/camera_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "maps/median.hpp"

namespace lodestar {
namespace {

double spread_rad(std::span<const Vec3> normals) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& normal : normals) sum += normal;
  const Vec3 mean = sum.normalized();
  double squared = 0.0;
  for (const Vec3& normal : normals) {
    const double angle = std::atan2(normal.cross(mean).norm(), normal.dot(mean));
    squared += angle * angle;
  }
  return std::sqrt(squared / static_cast<double>(normals.size()));
}

std::vector<std::size_t> outliers_of(const LensFit& fit, const CameraCalibrationOptions& options) {
  const double limit_px = std::max(options.outlier_ratio * median(fit.rms_px), options.most_rms_px);
  std::vector<std::size_t> outliers;
  for (std::size_t i = 0; i < fit.rms_px.size(); ++i) {
    if (fit.rms_px[i] > limit_px) outliers.push_back(i);
  }
  return outliers;
}

bool is_determined(const LensFit& fit, const CameraCalibrationOptions& options) {
  const CameraModel& camera = fit.camera;
  const bool has_center_inside = camera.cx_px >= 0.0 && camera.cx_px <= camera.width_px &&
                                 camera.cy_px >= 0.0 && camera.cy_px <= camera.height_px;
  return camera.fx_px > 0.0 && camera.fy_px > 0.0 && has_center_inside &&
         fit.sigmas.fx_px <= options.most_focal_sigma * camera.fx_px &&
         fit.sigmas.fy_px <= options.most_focal_sigma * camera.fy_px;
}

}  // namespace

Coverage coverage_of(std::span<const BoardView> views, int width_px, int height_px) {
  Coverage coverage;
  for (const BoardView& view : views) {
    for (const cv::Point2f& pixel : view.pixels) {
      const auto cell = [](float at, int side_px, int cells) {
        return std::clamp(
            static_cast<int>((at + 0.5F) * static_cast<float>(cells) / static_cast<float>(side_px)), 0,
            cells - 1);
      };
      const int column = cell(pixel.x, width_px, Coverage::columns);
      const int row = cell(pixel.y, height_px, Coverage::rows);
      coverage.cells[static_cast<std::size_t>(row * Coverage::columns + column)] = true;
    }
  }
  return coverage;
}

std::string_view to_string(CameraFlaw flaw) {
  switch (flaw) {
    case CameraFlaw::too_few_boards:
      return "too-few-boards";
    case CameraFlaw::one_orientation:
      return "one-orientation";
    case CameraFlaw::poor_coverage:
      return "poor-coverage";
    case CameraFlaw::large_error:
      return "large-error";
    case CameraFlaw::outlier_views:
      return "outlier-views";
    case CameraFlaw::undetermined:
      return "undetermined";
  }
  return "";
}

double Coverage::share() const {
  return static_cast<double>(std::ranges::count(cells, true)) / static_cast<double>(cells.size());
}

CameraCalibration calibrate_camera(std::span<const BoardView> views, int width_px, int height_px,
                                   const CameraCalibrationOptions& options) {
  CameraCalibration result{.coverage = coverage_of(views, width_px, height_px)};
  const auto refuse_if = [&result](bool flawed, CameraFlaw flaw) {
    if (flawed) result.flaws.push_back(flaw);
  };
  refuse_if(views.size() < options.least_boards, CameraFlaw::too_few_boards);
  refuse_if(result.coverage.share() < options.least_coverage, CameraFlaw::poor_coverage);
  constexpr std::size_t least_for_zhang = 3;
  if (views.size() < least_for_zhang) return result;

  result.fit = fit_lens(views, width_px, height_px, options.model);
  refuse_if(!result.fit || !is_determined(*result.fit, options), CameraFlaw::undetermined);
  if (!result.fit) return result;
  result.tilt_spread_rad = spread_rad(result.fit->board_normals);
  result.outliers = outliers_of(*result.fit, options);
  refuse_if(result.tilt_spread_rad < options.least_tilt_spread_rad, CameraFlaw::one_orientation);
  refuse_if(result.fit->all_rms_px > options.most_rms_px, CameraFlaw::large_error);
  refuse_if(!result.outliers.empty(), CameraFlaw::outlier_views);
  return result;
}

}  // namespace lodestar
