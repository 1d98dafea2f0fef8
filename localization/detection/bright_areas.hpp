#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "localization/detection/disjoint_sets.hpp"
#include "localization/detection/local_threshold.hpp"

// The thresholded frame as runs of bright pixels. Most of a frame is dark, so runs hold the binary image of
// Fig. 2b in a few hundred numbers, and all later steps touch bright pixels only.
namespace lodestar {

/// Bright pixels [begin, end) of one row.
struct Run {
  int row = 0;
  int begin = 0;
  int end = 0;
  friend bool operator==(const Run&, const Run&) = default;
};

/// A connected component: a range of BrightAreas::runs, and the moments of its pixels.
struct BrightArea {
  std::size_t first_run = 0;
  std::size_t run_count = 0;
  int area_px = 0;
  double mean_u_px = 0.0;
  double mean_v_px = 0.0;
  double aspect_ratio = 1.0;  ///< long over short axis of the ellipse with equal second moments
};

struct BrightAreas {
  std::vector<Run> runs;  ///< sorted by area, then row, then column
  std::vector<BrightArea> areas;

  [[nodiscard]] std::span<const Run> runs_of(const BrightArea& area) const {
    return std::span(runs).subspan(area.first_run, area.run_count);
  }
};

/// Groups runs (by row, then by column) into 8-connected components. Reuses its buffers.
class AreaConnector {
 public:
  /// The result is valid until the next call.
  const BrightAreas& connect(std::span<const Run> runs);

  [[nodiscard]] const BrightAreas& areas() const { return areas_; }

 private:
  std::vector<std::size_t> pieces_;  ///< provisional label of each run
  DisjointSets sets_;                ///< equivalent labels
  std::vector<std::size_t> numbers_;
  BrightAreas areas_;
};

/// Erosion by a cross of `side` pixels (odd; 1 changes nothing) of an area or of a whole frame: a pixel stays
/// when those left, right, above and below it within side / 2 are bright. On one connected component this
/// equals eroding the whole image, as a pixel's bright neighbours belong to its own component. Reuses its
/// buffers.
class Eroder {
 public:
  /// The result is valid until the next call.
  std::span<const Run> erode(std::span<const Run> runs, int side);

 private:
  std::vector<Run> left_;
  std::vector<Run> next_;
};

/// Finds a frame's bright areas: 8-connected components of pixels at or above their tile's threshold. Reuses
/// its buffers from frame to frame.
class BrightAreaFinder {
 public:
  /// `gray` is CV_8UC1, of the size that the thresholds are for. The result is valid until the next call.
  const BrightAreas& find(const cv::Mat& gray, const LocalThresholds& thresholds);

  [[nodiscard]] const BrightAreas& areas() const { return connector_.areas(); }

  /// The bright pixels of the last frame, by row, then by column.
  [[nodiscard]] std::span<const Run> runs() const { return runs_; }

 private:
  void find_runs(const cv::Mat& gray, const LocalThresholds& thresholds);

  struct ActiveTile {
    int left = 0;
    int width = 0;
    std::array<std::uint32_t, LocalThresholds::tile_px> bright_bits;  ///< one per row
  };
  std::vector<ActiveTile> active_;  ///< of one row of tiles
  std::vector<Run> runs_;
  AreaConnector connector_;
};

}  // namespace lodestar
