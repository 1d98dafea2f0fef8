#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/simulation/disc_profile.hpp"
#include "drivers/simulation/projected_disc.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// Light on the sensor before noise, in fixed point: 16 bits are enough, and eight pixels fit one register.
class LightImage {
 public:
  static constexpr int units_per_gray = 64;
  static constexpr double brightest_gray = 400.0;  ///< far into saturation; leaves room for noise in 16 bits

  LightImage(int width_px, int height_px);

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] std::int16_t* row(int v) { return values_.data() + offset_of(v); }
  [[nodiscard]] const std::int16_t* row(int v) const { return values_.data() + offset_of(v); }

  /// Lays a blurred ellipse over the picture, smeared evenly along `motion_px` about its centre.
  void paint(const ProjectedDisc& disc, const Vec2& motion_px, double gray, double sigma_px,
             const DiscProfile& profile);

  /// A straight piece of a tube. Each end is either round, with a half disc beyond it, or cut straight across
  /// the direction given, so that two pieces with the same cut join without gap or overlap.
  struct Band {
    Vec2 from_px = Vec2::Zero();
    Vec2 to_px = Vec2::Zero();
    double half_width_px = 0.0;
    std::optional<Vec2> cut_from;  ///< nothing: round
    std::optional<Vec2> cut_to;
  };

  /// Lays a blurred band over the picture.
  void paint(const Band& band, double gray, double sigma_px, const DiscProfile& profile);

 private:
  [[nodiscard]] std::size_t offset_of(int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(stride_);
  }

  int width_px_;
  int height_px_;
  int stride_;  ///< even, so that whoever fills a row two by two may write one pixel beyond it
  std::vector<std::int16_t> values_;
};

}  // namespace lodestar
