#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "localization/calibration/calibration_board.hpp"
#include "localization/calibration/lens_fit.hpp"

namespace lodestar {

/// Why a set of images does not calibrate a camera.
enum class CameraFlaw {
  too_few_boards,   ///< not enough images show the board
  one_orientation,  ///< the boards are nearly parallel: focal length and distance cannot be told apart
  poor_coverage,    ///< the corners leave too much of the image empty
  large_error,      ///< the reprojection error is too large
  outlier_views,    ///< some images fit far worse than the others
  undetermined      ///< no solution, or one that the images hardly determine
};

/// Name in results: `too-few-boards`.
std::string_view to_string(CameraFlaw flaw);

struct CameraCalibrationOptions {
  LensModel model = LensModel::pinhole;
  std::size_t least_boards = 8;
  double least_tilt_spread_rad = radians(8.0);  ///< root mean square angle of the boards to their mean
  double least_coverage = 0.5;                  ///< share of the cells that hold corners
  double most_rms_px = 0.5;                     ///< reprojection error over all corners
  /// An outlier's error is this many times the median image's, and more than most_rms_px.
  double outlier_ratio = 3.0;
  double most_focal_sigma = 0.01;  ///< standard deviation of the focal lengths, relative
};

/// The parts of the image that hold corners, on a grid of cells.
struct Coverage {
  static constexpr int columns = 8;
  static constexpr int rows = 6;
  std::array<bool, static_cast<std::size_t>(columns) * rows> cells{};  ///< row by row from the top

  [[nodiscard]] double share() const;
};

Coverage coverage_of(std::span<const BoardView> views, int width_px, int height_px);

/// Result of a set of views. The camera may be used when there are no flaws.
struct CameraCalibration {
  std::optional<LensFit> fit;  ///< nothing when there are too few boards or no solution
  Coverage coverage;
  double tilt_spread_rad = 0.0;
  std::vector<std::size_t> outliers;  ///< views that fit far worse than the others
  std::vector<CameraFlaw> flaws;
};

/// Fits the lens and checks the set.
CameraCalibration calibrate_camera(std::span<const BoardView> views, int width_px, int height_px,
                                   const CameraCalibrationOptions& options = {});

}  // namespace lodestar
