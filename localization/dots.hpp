#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "localization/bright_areas.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// One bright dot of a frame.
struct Dot {
  Vec2 center_px = Vec2::Zero();
  double radius_px = 0.0;        ///< of a uniform disc with the same light; blur does not change it
  double background_gray = 0.0;  ///< around the dot
  double contrast_gray = 0.0;    ///< of its middle over the background
};

struct DotOptions {
  int threshold = 200;       ///< gray value from which a pixel is bright (Fig. 2b)
  double min_area_px = 1.0;  ///< smaller bright areas are noise; faint small dots are a pixel or two
  double min_radius_px =
      1.3;  ///< of the light, not of the bright pixels: smaller dots are hot pixels and glints
  double max_area_px = 400.0;     ///< larger ones are tubes and lamps
  double max_aspect_ratio = 2.2;  ///< longer ones are tubes
  int erosion_px = 3;             ///< arm to arm of the cross that parts dots which touch; odd
  double tail_px = 2.5;           ///< how far a dot's blurred edge reaches beyond its bright pixels
  double center_margin_px = 0.8;  ///< light within so much of the dot's edge counts for its centre
};

/// The dots of a frame, and the eroded binary image (Fig. 2d) that each of them leaves.
struct DotImage {
  std::vector<Dot> dots;
  std::vector<std::vector<Run>> eroded;  ///< for each dot
};

/// Threshold, limits on area and aspect ratio, erosion, and the dots' centres (paper, section 4.1). Dots that
/// the frame's border cuts are left out. `gray` is CV_8UC1.
DotImage find_dots(const cv::Mat& gray, const DotOptions& options);

}  // namespace lodestar
