#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "maps/geometry.hpp"

// Sums of gray values over small discs: a dot's total light and its sub-pixel centroid.
namespace lodestar {

/// Light above the background within a disc, and its centroid. The disc's edge is soft (one pixel wide), so
/// that no pixel enters or leaves abruptly as the disc moves.
struct DiscLight {
  double mass = 0.0;  ///< gray values times pixels
  Vec2 center_px = Vec2::Zero();
};

/// Nothing when the frame's border cuts the disc.
std::optional<DiscLight> light_in_disc(const cv::Mat& gray, const Vec2& center_px, double radius_px,
                                       double background_gray);

/// Pixel weights of center_by_edge(). A weight that follows the edge closely admits less noise and less of
/// the dot's surroundings; one that is smooth from pixel to pixel does not depend on the dot's sub-pixel
/// position.
struct EdgeOptions {
  double half_width_px = 1.75;
  int most_steps = 2;
  double small_step_px = 0.06;  ///< after a step this small the remaining error is a tenth of it
  double longest_step_px = 1.0;
};

/// A dot's centre, from its edge. With a variance v of each pixel plus s times its light above the background
/// (shot noise), the centre's variance is v * variance_per_variance_px2 + s * variance_per_light_px2 per
/// coordinate.
struct DiscCenter {
  Vec2 center_px = Vec2::Zero();
  double variance_per_variance_px2 = 0.0;
  double variance_per_light_px2 = 0.0;
};

/// Sub-pixel centre of a dot of this radius, nearly as accurate as noise allows. Only the edge locates a dot:
/// of all sums of gray values that are zero on a symmetrical dot, the one weighted by the derivative of the
/// dot's image has the least variance. The weight here, x (1 - t^2)^2 with t = (d^2 - R^2) / (2 R h) and zero
/// for |t| > 1, follows a blurred edge. It ends so abruptly that an even background would show the pixel grid
/// in the sum, so the background is subtracted first. Newton's method from `start_px`, which must be accurate
/// to a few tenths of a pixel. Unbiased for a symmetrical dot, whatever the blur. Nothing when the frame's
/// border cuts the dot or there is no dot.
std::optional<DiscCenter> center_by_edge(const cv::Mat& gray, const Vec2& start_px, double radius_px,
                                         double background_gray, const EdgeOptions& options = {});

}  // namespace lodestar
