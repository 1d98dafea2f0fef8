#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "drivers/simulation/ceiling_kind.hpp"

namespace lodestar {

/// The reflectance of a kind of ceiling relative to its usual one, on a square that repeats: 1 on the plain
/// surface, less in grooves, more on a detector's cap.
struct SurfaceReflectance {
  static constexpr int side = 1024;
  static constexpr double period_m = 2.4;  ///< four tiles of 0.6 m
  static constexpr double texel_m = period_m / side;

  cv::Mat1f texels;

  /// At a point of the ceiling, bilinear between texel centres.
  [[nodiscard]] float at(double x_m, double y_m) const;

  /// Blurred by this sigma.
  [[nodiscard]] SurfaceReflectance blurred(double sigma_m) const;
};

/// Widths, spacings, tones and places depend on the seed.
SurfaceReflectance reflectance_of(CeilingKind kind, std::uint64_t seed);

}  // namespace lodestar
