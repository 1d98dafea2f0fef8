#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

// Flat boards for camera calibration.
namespace lodestar {

enum class BoardKind { chessboard, charuco };

struct CalibrationBoard {
  BoardKind kind = BoardKind::chessboard;
  int columns = 0;         ///< chessboard: inner corners in a row; ChArUco: squares in a row
  int rows = 0;            ///< and in a column
  double square_m = 0.0;   ///< side of a square, as measured on the print
  double marker_m = 0.0;   ///< ChArUco: side of a marker
  std::string dictionary;  ///< ChArUco: such as DICT_5X5_100
};

/// The board's corners in one image: positions on the board (z = 0) and in the image (pixel centres have
/// integer coordinates).
struct BoardView {
  std::vector<cv::Point3f> points_m;
  std::vector<cv::Point2f> pixels;
};

/// Finds the board in a gray image (CV_8UC1), with sub-pixel corners. A chessboard must be fully in view; a
/// part of a ChArUco board is enough. Nothing when there is none. Throws InputError for a ChArUco board with
/// an unknown dictionary, or in a build without OpenCV's aruco module.
std::optional<BoardView> find_board(const cv::Mat& gray, const CalibrationBoard& board);

}  // namespace lodestar
