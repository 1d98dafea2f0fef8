#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "maps/geometry.hpp"

// Sums of a frame's gray values over small discs: how much light a dot has, and where its middle is.
namespace lodestar {

/// Light above the background within a disc, and its centre. The disc's edge is soft (one pixel wide), so
/// that pixels do not jump in and out as the disc moves.
struct DiscLight {
  double mass = 0.0;  ///< gray values times pixels
  Vec2 center_px = Vec2::Zero();
};

/// Nothing when the frame's border cuts the disc.
std::optional<DiscLight> light_in_disc(const cv::Mat& gray, const Vec2& center_px, double radius_px,
                                       double background_gray);

/// How center_by_edge() weighs pixels. A weight that follows the edge closely lets less noise in, and less of
/// what else is around a dot; one that is smooth from pixel to pixel does not depend on where the dot lies
/// between them.
struct EdgeOptions {
  double half_width_px = 1.75;
  int most_steps = 2;
  double small_step_px = 0.06;  ///< after such a step the error left is a tenth of it
  double longest_step_px = 1.0;
};

/// A dot's middle by its edge. A pixel's variance v and a part s of its light above the background (shot
/// noise) add up to the middle's variance v * variance_per_variance_px2 + s * variance_per_light_px2, in each
/// coordinate.
struct DiscCenter {
  Vec2 center_px = Vec2::Zero();
  double variance_per_variance_px2 = 0.0;
  double variance_per_light_px2 = 0.0;
};

/// Where a dot of this radius lies, nearly to the accuracy that noise allows. Only the edge tells where a dot
/// is: of all sums of gray values that are zero on a symmetrical dot, the one weighted by the derivative of
/// the dot's own picture varies least with noise. The weight here is x (1 - t^2)^2, t = (d^2 - R^2) / (2 R
/// h), zero for |t| > 1: it follows a blurred edge. It ends so abruptly that pixels would show in its sum
/// over an even background; that is taken off first. Newton's method from `start_px`, which must be good to a
/// few tenths of a pixel. Whatever the blur, a symmetrical dot's middle is found without bias. Nothing when
/// the frame's border cuts the dot or there is no dot.
std::optional<DiscCenter> center_by_edge(const cv::Mat& gray, const Vec2& start_px, double radius_px,
                                         double background_gray, const EdgeOptions& options = {});

}  // namespace lodestar
