#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/simulation/disc_profile.hpp"
#include "drivers/simulation/projected_disc.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// Light on the sensor before noise, in 16-bit fixed point: eight pixels fit one register.
class LightImage {
 public:
  static constexpr int units_per_gray = 64;
  /// Well into saturation; leaves headroom for noise in 16 bits.
  static constexpr double brightest_gray = 400.0;

  LightImage(int width_px, int height_px);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] std::int16_t* row(int v) { return values_.data() + offset_of(v); }
  [[nodiscard]] const std::int16_t* row(int v) const { return values_.data() + offset_of(v); }

  /// Draws a blurred ellipse with motion blur along `motion_px`, symmetric about its centre.
  void paint(const ProjectedDisc& disc, const Vec2& motion_px, double gray, double sigma_px,
             const DiscProfile& profile);

  /// A straight segment of a tube. Each end is either round, with a half disc beyond it, or cut perpendicular
  /// to the given direction, so that two segments with the same cut join without gap or overlap.
  struct Band {
    Vec2 from_px = Vec2::Zero();
    Vec2 to_px = Vec2::Zero();
    double half_width_px = 0.0;
    std::optional<Vec2> cut_from;  ///< empty: round
    std::optional<Vec2> cut_to;
  };

  /// Draws a blurred band.
  void paint(const Band& band, double gray, double sigma_px, const DiscProfile& profile);

 private:
  [[nodiscard]] std::size_t offset_of(int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(stride_);
  }

  int width_px_;
  int height_px_;
  int stride_;  ///< even, so that code that writes pixels in pairs may write one beyond the row
  std::vector<std::int16_t> values_;
};

}  // namespace lodestar
