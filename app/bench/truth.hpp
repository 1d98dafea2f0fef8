#pragma once

#include <vector>

#include "app/bench/method.hpp"

// What is truly in view, and how a method's readings compare with it.
namespace lodestar {

struct TrueMarker {
  int id = 0;
  Vec2 center_px = Vec2::Zero();
};

/// All markers whose middle is in the picture or near it.
std::vector<TrueMarker> markers_in_view(const BenchMethod& method, const MarkerRegistry& registry,
                                        const Eigen::Isometry3d& map_from_camera, const CameraModel& camera);

struct ReadingCount {
  int right = 0;
  int wrong = 0;  ///< an ID where no such marker is, be it another's place or nobody's
};

/// A reading is right when a true marker of that ID has its middle within some pixels.
bool is_right(const ReadMarker& reading, const std::vector<TrueMarker>& truth);

ReadingCount judged(const std::vector<ReadMarker>& readings, const std::vector<TrueMarker>& truth);

}  // namespace lodestar
