#include "localization/calibration/calibration_board.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "localization/calibration/charuco.hpp"

namespace lodestar {
namespace {

std::vector<cv::Point3f> corners_on(const CalibrationBoard& board) {
  std::vector<cv::Point3f> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      points.emplace_back(static_cast<float>(column * board.square_m),
                          static_cast<float>(row * board.square_m), 0.0F);
    }
  }
  return points;
}

/// Half the side of a corner's refinement window, which holds no other corner: a third of the distance to the
/// nearest.
int refinement_window_px(const std::vector<cv::Point2f>& corners, int columns) {
  double nearest_px = 1e9;
  const auto step = static_cast<std::size_t>(columns);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if ((i + 1) % step != 0) nearest_px = std::min(nearest_px, cv::norm(corners[i + 1] - corners[i]));
    if (i + step < corners.size()) {
      nearest_px = std::min(nearest_px, cv::norm(corners[i + step] - corners[i]));
    }
  }
  return std::clamp(static_cast<int>(nearest_px / 3.0), 2, 11);
}

/// Searches for saddle points (Duda and Frese 2018), then with more effort, then for quadrangles.
bool find_roughly(const cv::Mat& gray, cv::Size size, std::vector<cv::Point2f>& corners) {
  constexpr int quick = cv::CALIB_CB_NORMALIZE_IMAGE;
  constexpr int thorough = quick | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY;
  constexpr int quadrangles =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK;
  return cv::findChessboardCornersSB(gray, size, corners, quick) ||
         cv::findChessboardCornersSB(gray, size, corners, thorough) ||
         cv::findChessboardCorners(gray, size, corners, quadrangles);
}

/// Sub-pixel corners: the gradients around a corner are orthogonal to the direction to it. Five times more
/// accurate than either search.
void refine(const cv::Mat& gray, int columns, std::vector<cv::Point2f>& corners) {
  const int window_px = refinement_window_px(corners, columns);
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-4);
  cv::cornerSubPix(gray, corners, {window_px, window_px}, {-1, -1}, until);
}

std::optional<BoardView> find_chessboard(const cv::Mat& gray, const CalibrationBoard& board) {
  BoardView view{.points_m = corners_on(board)};
  if (!find_roughly(gray, {board.columns, board.rows}, view.pixels)) return std::nullopt;
  refine(gray, board.columns, view.pixels);
  return view;
}

}  // namespace

std::optional<BoardView> find_board(const cv::Mat& gray, const CalibrationBoard& board) {
  return board.kind == BoardKind::charuco ? find_charuco_board(gray, board) : find_chessboard(gray, board);
}

}  // namespace lodestar
