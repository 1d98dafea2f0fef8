#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "localization/calibration/calibration_board.hpp"

namespace lodestar {

/// A chessboard whose white squares hold ArUco markers, so that a part of it is enough. The only place that
/// needs OpenCV's aruco module; a build without it throws InputError here, as does an unknown dictionary.
/// Nothing for fewer than eight corners or collinear corners.
std::optional<BoardView> find_charuco_board(const cv::Mat& gray, const CalibrationBoard& board);

}  // namespace lodestar
