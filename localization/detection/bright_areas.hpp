#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "localization/detection/disjoint_sets.hpp"
#include "localization/detection/local_threshold.hpp"

// The thresholded frame as runs of bright pixels. A frame of dots is nearly all dark, so runs hold the same
// binary image as Fig. 2b in a few hundred numbers, and all that follows touches bright pixels only.
namespace lodestar {

/// Bright pixels [begin, end) of one row.
struct Run {
  int row = 0;
  int begin = 0;
  int end = 0;
  friend bool operator==(const Run&, const Run&) = default;
};

/// One connected area: a stretch of BrightAreas::runs, and what its pixels sum up to.
struct BrightArea {
  std::size_t first_run = 0;
  std::size_t run_count = 0;
  int area_px = 0;
  double mean_u_px = 0.0;
  double mean_v_px = 0.0;
  double aspect_ratio = 1.0;  ///< long over short axis of the ellipse with the same second moments
};

struct BrightAreas {
  std::vector<Run> runs;  ///< area by area, within each by row and column
  std::vector<BrightArea> areas;

  [[nodiscard]] std::span<const Run> runs_of(const BrightArea& area) const {
    return std::span(runs).subspan(area.first_run, area.run_count);
  }
};

/// Parts runs (by row, then by column) into areas of pixels that touch, corners included. Keeps its memory.
class AreaConnector {
 public:
  /// The result holds until the next call.
  const BrightAreas& connect(std::span<const Run> runs);

  [[nodiscard]] const BrightAreas& areas() const { return areas_; }

 private:
  std::vector<std::size_t> pieces_;  ///< of areas, for each run
  DisjointSets sets_;                ///< of pieces that touch
  std::vector<std::size_t> numbers_;
  BrightAreas areas_;
};

/// Erosion by a cross of `side` pixels (odd; 1 leaves all as it is) of an area or of a whole frame: a pixel
/// stays when those left, right, above and below it within side / 2 are bright. On one connected area the
/// result is that of eroding the whole image, for a pixel's bright neighbours belong to the pixel's own area.
/// Keeps its memory.
class Eroder {
 public:
  /// The result holds until the next call.
  std::span<const Run> erode(std::span<const Run> runs, int side);

 private:
  std::vector<Run> left_;
  std::vector<Run> next_;
};

/// Finds a frame's bright areas: pixels at or above their tile's threshold that touch, corners included.
/// Keeps its memory from frame to frame.
class BrightAreaFinder {
 public:
  /// `gray` is CV_8UC1, of the size that the thresholds are for. The result holds until the next call.
  const BrightAreas& find(const cv::Mat& gray, const LocalThresholds& thresholds);

  [[nodiscard]] const BrightAreas& areas() const { return connector_.areas(); }

  /// The bright pixels of the last frame, by row, then by column.
  [[nodiscard]] std::span<const Run> runs() const { return runs_; }

 private:
  void find_runs(const cv::Mat& gray, const LocalThresholds& thresholds);

  struct ActiveTile {
    int left = 0;
    int width = 0;
    std::array<std::uint32_t, LocalThresholds::tile_px> bright_bits;  ///< row by row
  };
  std::vector<ActiveTile> active_;  ///< of one row of tiles
  std::vector<Run> runs_;
  AreaConnector connector_;
};

}  // namespace lodestar
