#pragma once

#include <optional>
#include <vector>

#include "localization/calibration/calibration_board.hpp"

namespace lodestar {

/// Which views of a calibration board to take from a video or a live camera: those in which it is held still,
/// each unlike those already taken.
class BoardChoice {
 public:
  explicit BoardChoice(int width_px) : width_px_(width_px) {}

  /// Is this the view to take? The view of the next frame; nothing without the board in it.
  bool takes(const std::optional<BoardView>& view);

 private:
  int width_px_;
  std::optional<BoardView> before_;
  std::vector<BoardView> taken_;
};

}  // namespace lodestar
