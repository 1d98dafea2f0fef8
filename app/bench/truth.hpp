#pragma once

#include <vector>

#include "app/bench/method.hpp"

// Ground truth of the markers in view, and how a method's readings compare with it.
namespace lodestar {

struct TrueMarker {
  int id = 0;
  Vec2 center_px = Vec2::Zero();
};

/// All markers whose centre is within 100 px of the image.
std::vector<TrueMarker> markers_in_view(const BenchMethod& method, const MarkerRegistry& registry,
                                        const Eigen::Isometry3d& map_from_camera, const CameraModel& camera);

struct ReadingCount {
  int right = 0;
  int wrong = 0;  ///< an ID where no such marker is
};

/// A reading is right when a true marker of that ID has its centre within 5 px.
bool is_right(const ReadMarker& reading, const std::vector<TrueMarker>& truth);

/// Is one of the readings right about this marker?
bool is_read(const TrueMarker& marker, const std::vector<ReadMarker>& readings);

ReadingCount judged(const std::vector<ReadMarker>& readings, const std::vector<TrueMarker>& truth);

}  // namespace lodestar
