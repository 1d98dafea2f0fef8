#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

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

/// The bright pixels (gray value >= threshold) of a CV_8UC1 frame, by row, then by column.
std::vector<Run> bright_runs(const cv::Mat& gray, int threshold);

/// One connected area: a stretch of BrightAreas::runs, and what its pixels sum up to.
struct BrightArea {
  std::size_t first_run = 0;
  std::size_t run_count = 0;
  int left = 0;
  int top = 0;
  int right = 0;   ///< last column
  int bottom = 0;  ///< last row
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

/// Parts runs (by row, then by column) into areas of pixels that touch, corners included.
BrightAreas connected_areas(std::span<const Run> runs);

/// Erosion by a cross of `side` pixels (odd; 1 leaves all as it is) of an area or of a whole frame: a pixel
/// stays when those left, right, above and below it within side / 2 are bright. On one connected area the
/// result is that of eroding the whole image, for a pixel's bright neighbours belong to the pixel's own area.
std::vector<Run> eroded(std::span<const Run> runs, int side);

}  // namespace lodestar
