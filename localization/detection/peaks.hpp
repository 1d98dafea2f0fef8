#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "localization/detection/bright_areas.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

struct PeakOptions {
  /// A peak stands out from its surroundings by this share of the brightest one's height ...
  double least_prominence = 0.06;
  double prominence_sigmas = 3.0;  ///< ... and by this many sigmas of the smoothed image's noise
};

/// Local maxima of the smoothed frame among an area's pixels: dots that blur has run together. Reuses its
/// buffers.
class PeakFinder {
 public:
  explicit PeakFinder(const PeakOptions& options = {}) : options_(options) {}

  /// Places of the peaks; valid until the next call. `gray` is CV_8UC1, `area` not empty.
  std::span<const Vec2> find(const cv::Mat& gray, std::span<const Run> area, double background_gray,
                             double noise_gray);

 private:
  struct Peak {
    Vec2 place_px;
    double prominence = 0.0;
  };

  PeakOptions options_;
  std::vector<float> smoothed_;
  std::vector<Peak> peaks_;
  std::vector<Vec2> places_;
};

}  // namespace lodestar
