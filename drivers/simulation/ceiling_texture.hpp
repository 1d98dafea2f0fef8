#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lodestar {

inline constexpr double ceiling_tile_m = 0.6;  ///< side of a mineral-fibre tile

/// Texture of a tiled ceiling, without lights: joints, tiles of different tone, stains, specks. It repeats
/// after eight tiles, more than a camera sees at once; coordinates are 32-bit fractions of that period, which
/// wrap without extra code.
class CeilingTexture {
 public:
  static constexpr int side = 1024;  ///< texels; small enough for the processor's cache
  static constexpr double period_m = 8 * ceiling_tile_m;
  static constexpr int units_per_amplitude = 32;

  explicit CeilingTexture(std::uint64_t seed);

  /// Coordinate along x or y from a tile's corner, in 2^-32 of the period.
  static std::uint32_t wrapped(double from_corner_m);

  /// In units of the texture's amplitude; about -3..2, mean near 0.
  [[nodiscard]] std::int8_t at(std::uint32_t x, std::uint32_t y) const {
    constexpr int shift = 22;  // 2^32 over 2^10 texels
    return texels_[static_cast<std::size_t>(y >> shift) * side + (x >> shift)];
  }

 private:
  std::vector<std::int8_t> texels_;
};

}  // namespace lodestar
