#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "localization/detection/inline_vector.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

struct JointFitOptions {
  int most_iterations = 12;   ///< of Levenberg and Marquardt
  double least_share = 0.35;  ///< of the median dot's light; a start with less is no dot
  double reach_sigmas = 2.5;  ///< pixels within this distance of a dot take part
  double most_error = 0.15;   ///< RMS of the fit's residuals as a share of a dot's height; more is no fit
};

/// What is known of the light around dots before they are fitted.
struct DotLight {
  double width_px = 0.0;  ///< sigma of a dot's Gaussian
  double background_gray = 0.0;
  double noise_gray = 0.0;         ///< of a pixel in the dark
  double variance_per_gray = 0.0;  ///< of its shot noise
};

/// One of several dots fitted together. A small dot behind that much blur is a Gaussian: its light and place
/// can be known, its radius cannot.
struct FittedDot {
  std::size_t start = 0;  ///< index of its start
  Vec2 center_px = Vec2::Zero();
  double sigma_px = 0.0;     ///< standard deviation of each coordinate of the centre
  double height_gray = 0.0;  ///< above the background
};

constexpr std::size_t most_joint_dots = 24;

struct FittedDots {
  InlineVector<FittedDot, most_joint_dots> dots;
  double width_px = 0.0;  ///< sigma of every dot's Gaussian
  double background_gray = 0.0;
};

struct GrayPixel {
  Vec2 place_px;
  double gray = 0.0;
};

/// Least squares over the pixels about the starts: a centre and a height for each dot, one width and one
/// background for all. Reuses its buffers.
class JointFit {
 public:
  explicit JointFit(const JointFitOptions& options = {}) : options_(options) {}

  /// Empty when there are more than `most_joint_dots` starts, when it does not converge, or when the dots do
  /// not explain the pixels. `gray` is CV_8UC1.
  FittedDots fit(const cv::Mat& gray, std::span<const Vec2> starts_px, const DotLight& light);

 private:
  JointFitOptions options_;
  std::vector<GrayPixel> pixels_;
};

}  // namespace lodestar
