#include "drivers/simulation/surface_reflectance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <opencv2/core.hpp>

#include "drivers/simulation/periodic_noise.hpp"
#include "maps/geometry.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr int side = SurfaceReflectance::side;
constexpr double period_m = SurfaceReflectance::period_m;
constexpr double texel_m = SurfaceReflectance::texel_m;

enum SurfacePurpose : std::uint64_t { stains = 31, specks, shapes, details };

/// Distance from the nearest multiple of the spacing.
double from_multiple(double value, double spacing) {
  return std::abs(value - spacing * std::round(value / spacing));
}

/// 1 inside, 0 outside, linear over one texel.
double inside(double depth_m) {
  return std::clamp(0.5 + depth_m / texel_m, 0.0, 1.0);
}

/// Difference of two coordinates on the square whose sides join.
double around(double difference) {
  return difference - period_m * std::round(difference / period_m);
}

/// Calls `change(x_m, y_m, reflectance)` for every texel.
template <typename Change>
void for_each_texel(cv::Mat1f& texels, const Change& change) {
  for (int row = 0; row < side; ++row) {
    auto* const values = texels.ptr<float>(row);
    for (int column = 0; column < side; ++column)
      values[column] = static_cast<float>(
          change((column + 0.5) * texel_m, (row + 0.5) * texel_m, static_cast<double>(values[column])));
  }
}

/// Calls `change(distance_x_m, distance_y_m, reflectance)` for the texels within `reach_m` of a point.
template <typename Change>
void for_each_texel_near(cv::Mat1f& texels, const Vec2& middle_m, double reach_m, const Change& change) {
  const auto first = [&](double middle) {
    return static_cast<int>(std::floor((middle - reach_m) / texel_m));
  };
  const int count = static_cast<int>(std::ceil(2.0 * reach_m / texel_m)) + 1;
  for (int i = 0; i < count; ++i) {
    const int row = first(middle_m.y()) + i;
    for (int j = 0; j < count; ++j) {
      const int column = first(middle_m.x()) + j;
      float& value = texels(row & (side - 1), column & (side - 1));
      value = static_cast<float>(change((column + 0.5) * texel_m - middle_m.x(),
                                        (row + 0.5) * texel_m - middle_m.y(), static_cast<double>(value)));
    }
  }
}

double mixed(double from, double to, double share) {
  return from + share * (to - from);
}

/// A plain surface with soft stains and fine grain.
cv::Mat1f plain(double stain, double grain, const Random& random) {
  constexpr double stain_m = 0.12;
  const cv::Mat1f soft = smooth_noise(side, stain_m / texel_m, stain_m / texel_m, random.stream(stains));
  cv::Mat1f texels = smooth_noise(side, 1.0, 1.0, random.stream(specks));
  cv::addWeighted(soft, stain, texels, grain, 1.0, texels);
  return texels;
}

/// Panels of this side, each of its own tone, with dark gaps between them.
void lay_panels(cv::Mat1f& texels, double panel_m, Random random) {
  const double half_gap_m = 0.5 * random.uniform(0.002, 0.010);
  const double gap = random.uniform(0.1, 0.5);
  const int count = static_cast<int>(std::lround(period_m / panel_m));
  std::vector<double> tones;
  for (int i = 0; i < count * count; ++i) tones.push_back(1.0 + 0.04 * random.normal());
  for_each_texel(texels, [&](double x, double y, double value) {
    const int column = std::min(static_cast<int>(x / panel_m), count - 1);
    const int row = std::min(static_cast<int>(y / panel_m), count - 1);
    const double from_gap = std::min(from_multiple(x, panel_m), from_multiple(y, panel_m));
    return mixed(value * tones[static_cast<std::size_t>(row * count + column)], gap,
                 inside(half_gap_m - from_gap));
  });
}

/// Boards along x with grooves between them, each cut somewhere along its length.
void lay_planks(cv::Mat1f& texels, Random random) {
  const int count = 17 + static_cast<int>(random.below(9));  // boards of 96 to 141 mm
  const double width_m = period_m / count;
  const double half_groove_m = 0.5 * random.uniform(0.003, 0.008);
  const double groove = random.uniform(0.1, 0.4);
  std::vector<double> tones;
  std::vector<double> cuts_m;
  for (int i = 0; i < count; ++i) {
    tones.push_back(1.0 + 0.08 * random.normal());
    cuts_m.push_back(random.uniform(0.0, period_m));
  }
  for_each_texel(texels, [&](double x, double y, double value) {
    const auto board = static_cast<std::size_t>(std::min(static_cast<int>(y / width_m), count - 1));
    constexpr double half_cut_m = 0.001;
    const double depth_m =
        std::max(half_groove_m - from_multiple(y, width_m), half_cut_m - std::abs(around(x - cuts_m[board])));
    return mixed(value * tones[board], groove, inside(depth_m));
  });
}

/// Veins are noise drawn out along x; their dark crests are narrow.
void add_veins(cv::Mat1f& texels, const Random& random) {
  const cv::Mat1f soft = smooth_noise(side, 60.0, 2.5, random.stream(stains));
  const cv::Mat1f fine = smooth_noise(side, 40.0, 0.8, random.stream(specks));
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double crest = std::max(0.0, static_cast<double>(fine(row, column)) - 1.5);
      const double vein = 0.06 * static_cast<double>(soft(row, column)) - 0.25 * crest;
      texels(row, column) *= static_cast<float>(std::clamp(1.0 + vein, 0.3, 1.3));
    }
  }
}

/// Ellipses, darker towards their rim, drawn out along the veins.
void add_knots(cv::Mat1f& texels, Random random) {
  constexpr int count = 30;
  for (int i = 0; i < count; ++i) {
    const Vec2 middle(random.uniform(0.0, period_m), random.uniform(0.0, period_m));
    const double radius_m = random.uniform(0.004, 0.012);
    const double tone = random.uniform(0.35, 0.7);
    constexpr double elongation = 1.6;
    for_each_texel_near(texels, middle, elongation * radius_m + texel_m,
                        [&](double x, double y, double value) {
                          return mixed(value, tone * value, inside(radius_m - std::hypot(x / elongation, y)));
                        });
  }
}

/// Thin wandering lines.
void add_cracks(cv::Mat1f& texels, Random random) {
  constexpr int count = 6;
  constexpr double step_m = 0.5 * texel_m;
  for (int i = 0; i < count; ++i) {
    Vec2 at(random.uniform(0.0, period_m), random.uniform(0.0, period_m));
    double heading_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double tone = random.uniform(0.4, 0.75);
    const double length_m = random.uniform(0.5, 2.0);
    for (double gone_m = 0.0; gone_m < length_m; gone_m += step_m) {
      heading_rad += 0.06 * random.normal();
      at += step_m * Vec2(std::cos(heading_rad), std::sin(heading_rad));
      const auto texel = [](double value) {
        return static_cast<int>(std::floor((value - period_m * std::floor(value / period_m)) / texel_m)) %
               side;
      };
      texels(texel(at.y()), texel(at.x())) = static_cast<float>(tone);
    }
  }
}

/// Light that comes from one side: half a wave and a quarter across the period.
void light_unevenly(cv::Mat1f& texels, Random random) {
  const double phase = random.uniform(-std::numbers::pi, std::numbers::pi);
  constexpr double amplitude = 0.15;
  for_each_texel(texels, [&](double x, double y, double value) {
    const double wave = std::sin(2.0 * std::numbers::pi * x / period_m + phase) +
                        std::cos(2.0 * std::numbers::pi * y / period_m + phase);
    return value * (1.0 + amplitude * wave);
  });
}

/// Every other panel is a louvre or a perforated plate with a frame.
void put_vents(cv::Mat1f& texels, double panel_m, Random random) {
  const double slat_m = panel_m / static_cast<double>(15 + random.below(16));  // 20 to 40 mm
  const double hole_share = random.uniform(0.25, 0.4);
  const double slot = random.uniform(0.15, 0.45);
  const double open_share = random.uniform(0.3, 0.5);
  const double hole_m = panel_m / static_cast<double>(18 + random.below(43));  // 10 to 33 mm
  const double hole_radius_m = hole_share * hole_m;
  constexpr double frame_m = 0.03;
  const int count = static_cast<int>(std::lround(period_m / panel_m));
  for_each_texel(texels, [&](double x, double y, double value) {
    const int column = std::min(static_cast<int>(x / panel_m), count - 1);
    const int row = std::min(static_cast<int>(y / panel_m), count - 1);
    const double from_edge = std::min(from_multiple(x, panel_m), from_multiple(y, panel_m));
    if ((row + column) % 2 == 0 || from_edge < frame_m) return value;
    const bool is_louvre = row % 2 == 0;
    const double depth_m =
        is_louvre ? 0.5 * open_share * slat_m - from_multiple(y, slat_m)
                  : hole_radius_m - std::hypot(from_multiple(x, hole_m), from_multiple(y, hole_m));
    return mixed(value, slot, inside(depth_m));
  });
}

/// Slats along x every 20 to 100 mm. A dot over the middle of a wider slot would have nothing to hold on.
void lay_slats(cv::Mat1f& texels, Random random) {
  const double spacing_m = period_m / std::round(period_m / random.uniform(0.02, 0.1));
  const double slot_m = std::min(random.uniform(0.006, 0.016), 0.4 * spacing_m);
  const double slot = random.uniform(0.15, 0.45);
  for_each_texel(texels, [&](double, double y, double value) {
    return mixed(value, slot, inside(0.5 * slot_m - from_multiple(y, spacing_m)));
  });
}

/// A cap with a dark gap around it and a dark chamber in its middle, or a sprinkler's rosette with a bright
/// pin.
void put_detectors(cv::Mat1f& texels, Random random) {
  constexpr int count = 14;
  for (int i = 0; i < count; ++i) {
    const Vec2 middle(random.uniform(0.0, period_m), random.uniform(0.0, period_m));
    const bool is_sprinkler = random.below(3) == 0;
    const double radius_m = is_sprinkler ? random.uniform(0.02, 0.03) : random.uniform(0.035, 0.06);
    const double pin_m = random.uniform(0.004, 0.008);
    const double cap = random.uniform(0.8, 1.25);
    for_each_texel_near(texels, middle, radius_m + texel_m, [&](double x, double y, double value) {
      const double distance_m = std::hypot(x, y);
      constexpr double rim_m = 0.004;
      double result = mixed(value, 0.4, inside(radius_m - distance_m));
      result =
          mixed(result, cap * (1.1 - 0.2 * distance_m / radius_m), inside(radius_m - rim_m - distance_m));
      return mixed(result, is_sprinkler ? 1.6 : 0.3, inside(pin_m - distance_m));
    });
  }
}

}  // namespace

float SurfaceReflectance::at(double x_m, double y_m) const {
  const double x = x_m / texel_m - 0.5;
  const double y = y_m / texel_m - 0.5;
  const double left = std::floor(x);
  const double top = std::floor(y);
  const auto fx = static_cast<float>(x - left);
  const auto fy = static_cast<float>(y - top);
  constexpr std::int64_t mask = side - 1;
  const auto column = static_cast<std::int64_t>(left);
  const auto row = static_cast<std::int64_t>(top);
  const auto* const above = texels.ptr<float>(static_cast<int>(row & mask));
  const auto* const below = texels.ptr<float>(static_cast<int>((row + 1) & mask));
  const std::int64_t a = column & mask;
  const std::int64_t b = (column + 1) & mask;
  const float high = above[a] + fx * (above[b] - above[a]);
  const float low = below[a] + fx * (below[b] - below[a]);
  return high + fy * (low - high);
}

SurfaceReflectance SurfaceReflectance::blurred(double sigma_m) const {
  const double sigma = sigma_m / texel_m;
  return {blurred_periodically(texels, sigma, sigma)};
}

SurfaceReflectance reflectance_of(CeilingKind kind, std::uint64_t seed) {
  const Random random(seed);
  const Random shape = random.stream(shapes);
  constexpr double tile_m = 0.6;
  cv::Mat1f texels = plain(0.03, 0.02, random);
  switch (kind) {
    case CeilingKind::tiles:
    case CeilingKind::joints:
      lay_panels(texels, shape.stream(details).below(2) == 0 ? tile_m : 0.5 * tile_m, shape);
      break;
    case CeilingKind::planks:
      lay_planks(texels, shape);
      break;
    case CeilingKind::veneer:
      add_veins(texels, random.stream(details));
      add_knots(texels, shape);
      break;
    case CeilingKind::plaster:
      light_unevenly(texels, shape);
      add_cracks(texels, shape);
      break;
    case CeilingKind::vents:
      lay_panels(texels, tile_m, shape);
      put_vents(texels, tile_m, shape);
      break;
    case CeilingKind::slats:
      lay_slats(texels, shape);
      break;
    case CeilingKind::detectors:
      put_detectors(texels, shape);
      break;
    case CeilingKind::reflectors:
      lay_panels(texels, tile_m, shape);
      break;
    case CeilingKind::glossy:
      break;
  }
  return {texels};
}

}  // namespace lodestar
