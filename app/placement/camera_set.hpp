#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/frames/frame_source.hpp"
#include "localization/calibration/calibration_board.hpp"
#include "localization/calibration/camera_calibration.hpp"

namespace lodestar {

/// The images of one camera calibration: where the board was seen, and where not.
struct CameraSet {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::string> files;  ///< images with the board, in the order of the views
  std::vector<BoardView> views;
  std::vector<std::string> files_without_board;
};

/// Looks for the board in each frame, one at a time. Of a video or a live camera only views with the board
/// held still at a new place are taken, and enough of them end it; `taken` is told of each. Throws InputError
/// for a frame that cannot be read, and for frames of different sizes.
CameraSet read_camera_set(FrameSource& frames, const CalibrationBoard& board,
                          const std::function<void(const CameraSet& so_far)>& taken);

/// The result as text: reprojection errors of all images, coverage as a character map, intrinsics with
/// standard deviations.
std::string text_report(const CameraSet& set, const CameraCalibration& calibration);

/// The same as JSON.
nlohmann::ordered_json json_report(const CameraSet& set, const CameraCalibration& calibration);

/// Why the set cannot be used, one line per flaw, with what was found and what is wanted; empty when it can.
std::vector<std::string> complaints(const CameraSet& set, const CameraCalibration& calibration,
                                    const CameraCalibrationOptions& options);

}  // namespace lodestar
