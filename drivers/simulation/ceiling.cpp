#include "drivers/simulation/ceiling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "drivers/simulation/ceiling_texture.hpp"
#include "maps/marker.hpp"
#include "maps/median.hpp"
#include "maps/random.hpp"
#include "maps/segment.hpp"

namespace lodestar {
namespace {

enum CeilingPurpose : std::uint64_t {
  dots_of_markers = 11,
  places_of_lamps,
  places_of_glints,
  places_of_dots,
  place_of_tiles,
  tilt_of_marker
};

constexpr double margin_m = 3.0;  ///< ceiling beyond the outermost markers
constexpr double default_height_m = 2.5;

constexpr double tube_half_length_m = 0.59;  ///< a T8 tube of 36 W
constexpr double tube_radius_m = 0.016;      ///< with the glow of its reflector
constexpr double tube_gray = 330.0;
const Vec2 tube_spacing_m(5 * ceiling_tile_m, 4 * ceiling_tile_m);

/// A tube in a reflector, as bands from the reflector's rim to the tube.
struct ReflectorBand {
  double half_width_m = 0.0;
  double gray = 0.0;
};
constexpr std::array reflector_bands{ReflectorBand{0.085, 150.0}, ReflectorBand{0.065, 185.0},
                                     ReflectorBand{0.04, 230.0}, ReflectorBand{0.018, 360.0}};
const Vec2 reflector_spacing_m(2 * ceiling_tile_m, 2 * ceiling_tile_m);
constexpr double reflector_clearance_m = 0.19;  ///< from its axis to the centre of a marker

const Vec2 lamp_spacing_m(4 * ceiling_tile_m, 4 * ceiling_tile_m);
constexpr double light_clearance_m = 0.3;  ///< between a light and the centre of a marker

constexpr double glints_per_m2 = 0.4;
constexpr double glint_clearance_m = 0.03;  ///< from a marker's film

/// An axis-aligned rectangle of the ceiling.
struct Extent {
  Vec2 low_m = Vec2::Zero();
  Vec2 high_m = Vec2::Zero();
};

/// About the marker's dot O.
Eigen::Isometry3d draw_tilt(double sigma_rad, Random random) {
  const double about_x_rad = sigma_rad * random.normal();
  const double about_y_rad = sigma_rad * random.normal();
  Eigen::Isometry3d tilt = Eigen::Isometry3d::Identity();
  tilt.linear() = rotation_from({about_x_rad, about_y_rad, 0.0});
  return tilt;
}

CeilingMarker installed_marker(const MarkerRegistry& registry, const RegisteredMarker& marker,
                               const SimulatedCameraOptions& options, Random random) {
  Random places = random.stream(places_of_dots);
  CeilingMarker result;
  result.map_from_marker = map_from_marker(registry, marker) *
                           draw_tilt(options.marker_tilt_sigma_rad, random.stream(tilt_of_marker));
  const auto in_map = [&](const Vec2& in_marker) -> Vec3 {
    const Vec2 printed = options.print_scale * in_marker;
    return result.map_from_marker * Vec3(printed.x(), printed.y(), 0.0);
  };
  result.middle_m = in_map(Vec2::Constant(0.5 * (marker_grid_size - 1) * marker_pitch_m));
  for (const GridCell cell : dots_of(marker.id)) {
    Vec2 glued = cell_in_marker(cell);
    for (double& coordinate : glued) coordinate += options.dot_place_sigma_m * places.normal();
    result.dots.push_back({in_map(glued), options.print_scale * marker_dot_radius_m,
                           options.dot_gray + options.dot_gray_sigma * random.normal()});
  }
  return result;
}

double median_height_m(const std::vector<CeilingMarker>& markers) {
  if (markers.empty()) return default_height_m;
  std::vector<double> heights;
  for (const CeilingMarker& marker : markers) heights.push_back(marker.middle_m.z());
  return median(std::move(heights));
}

Extent extent_of(const std::vector<CeilingMarker>& markers) {
  if (markers.empty()) return {Vec2::Constant(-margin_m), Vec2::Constant(margin_m)};
  Extent extent{Vec2::Constant(std::numeric_limits<double>::infinity()),
                Vec2::Constant(-std::numeric_limits<double>::infinity())};
  for (const CeilingMarker& marker : markers) {
    extent.low_m = extent.low_m.cwiseMin(marker.middle_m.head<2>());
    extent.high_m = extent.high_m.cwiseMax(marker.middle_m.head<2>());
  }
  return {extent.low_m.array() - margin_m, extent.high_m.array() + margin_m};
}

bool is_clear(const CeilingTube& tube, const std::vector<CeilingMarker>& markers,
              double clearance_m = light_clearance_m) {
  return std::ranges::none_of(markers, [&](const CeilingMarker& marker) {
    return distance_to_segment(tube.from_m.head<2>(), tube.to_m.head<2>(), marker.middle_m.head<2>()) <
           clearance_m;
  });
}

bool is_clear(const CeilingDisc& lamp, const Ceiling& ceiling) {
  const Vec2 center = lamp.center_m.head<2>();
  const bool of_markers = std::ranges::none_of(ceiling.markers, [&](const CeilingMarker& marker) {
    return (marker.middle_m.head<2>() - center).norm() < light_clearance_m + lamp.radius_m;
  });
  return of_markers && std::ranges::none_of(ceiling.tubes, [&](const CeilingTube& tube) {
           return distance_to_segment(tube.from_m.head<2>(), tube.to_m.head<2>(), center) <
                  light_clearance_m + lamp.radius_m;
         });
}

bool is_off_film(const CeilingDisc& glint, const CeilingMarker& marker) {
  const Vec3 in_marker = marker.map_from_marker.inverse() * glint.center_m;
  const Vec3 middle = marker.map_from_marker.inverse() * marker.middle_m;
  return (in_marker - middle).head<2>().cwiseAbs().maxCoeff() >
         marker_film_half_side_m + glint.radius_m + glint_clearance_m;
}

/// Coordinates of tile centres along one axis, at the given spacing in metres.
std::vector<double> tile_middles_m(double low, double high, double spacing, double tile_corner) {
  std::vector<double> middles;
  const double first = tile_corner + spacing * std::ceil((low - tile_corner) / spacing);
  for (double middle = first + 0.5 * ceiling_tile_m; middle < high; middle += spacing)
    middles.push_back(middle);
  return middles;
}

std::vector<Vec2> tile_middles_m(const Extent& extent, const Vec2& spacing_m, const Vec2& tile_corner_m) {
  std::vector<Vec2> middles;
  for (const double y : tile_middles_m(extent.low_m.y(), extent.high_m.y(), spacing_m.y(), tile_corner_m.y()))
    for (const double x :
         tile_middles_m(extent.low_m.x(), extent.high_m.x(), spacing_m.x(), tile_corner_m.x()))
      middles.emplace_back(x, y);
  return middles;
}

Vec2 draw_tile_corner(Random random) {
  const double x_m = random.uniform(0.0, ceiling_tile_m);
  return {x_m, random.uniform(0.0, ceiling_tile_m)};
}

std::vector<CeilingTube> fit_tubes(const Ceiling& ceiling, const Extent& extent) {
  std::vector<CeilingTube> tubes;
  for (const Vec2& middle : tile_middles_m(extent, tube_spacing_m, ceiling.tile_corner_m)) {
    // If a marker is in the way, the light is moved by one tile.
    for (const double shift : {0.0, ceiling_tile_m, -ceiling_tile_m}) {
      const Vec3 at(middle.x(), middle.y() + shift, ceiling.height_m);
      const Vec3 half_length(tube_half_length_m, 0.0, 0.0);
      const CeilingTube tube{at - half_length, at + half_length, tube_radius_m, tube_gray};
      if (!is_clear(tube, ceiling.markers)) continue;
      tubes.push_back(tube);
      break;
    }
  }
  return tubes;
}

/// Rows of luminaires; those in the way of a marker are left out.
std::vector<CeilingTube> fit_reflectors(const Ceiling& ceiling, const Extent& extent) {
  std::vector<CeilingTube> tubes;
  for (const Vec2& middle : tile_middles_m(extent, reflector_spacing_m, ceiling.tile_corner_m)) {
    const Vec3 at(middle.x(), middle.y(), ceiling.height_m);
    const Vec3 half_length(tube_half_length_m - reflector_bands.front().half_width_m, 0.0, 0.0);
    const CeilingTube axis{at - half_length, at + half_length, 0.0, 0.0};
    if (!is_clear(axis, ceiling.markers, reflector_clearance_m)) continue;
    for (const ReflectorBand& band : reflector_bands)
      tubes.push_back({axis.from_m, axis.to_m, band.half_width_m, band.gray});
  }
  return tubes;
}

std::vector<CeilingDisc> fit_lamps(const Ceiling& ceiling, const Extent& extent, Random random) {
  constexpr double share_of_places = 0.5;
  std::vector<CeilingDisc> lamps;
  for (const Vec2& middle : tile_middles_m(extent, lamp_spacing_m, ceiling.tile_corner_m)) {
    const double radius_m = random.uniform(0.035, 0.08);
    const double gray = random.uniform(280.0, 400.0);
    const Vec3 between_tubes(middle.x(), middle.y() + 2 * ceiling_tile_m, ceiling.height_m);
    const CeilingDisc lamp{between_tubes, radius_m, gray};
    if (random.uniform() < share_of_places && is_clear(lamp, ceiling)) lamps.push_back(lamp);
  }
  return lamps;
}

/// Screws, sprinkler heads, foil: most are points, one in four is as large and bright as a dot.
CeilingDisc draw_glint(const Extent& extent, double height_m, Random& random) {
  const double x = random.uniform(extent.low_m.x(), extent.high_m.x());
  const double y = random.uniform(extent.low_m.y(), extent.high_m.y());
  const bool is_like_a_dot = random.uniform() < 0.25;
  const double radius_m = is_like_a_dot ? random.uniform(0.008, 0.012) : random.uniform(0.0015, 0.005);
  const double gray = is_like_a_dot ? random.uniform(220.0, 300.0) : random.uniform(120.0, 400.0);
  return {{x, y, height_m}, radius_m, gray};
}

std::vector<CeilingDisc> scatter_glints(const Ceiling& ceiling, const Extent& extent, Random random) {
  const auto count = static_cast<int>(glints_per_m2 * (extent.high_m - extent.low_m).prod());
  std::vector<CeilingDisc> glints;
  for (int i = 0; i < count; ++i) {
    const CeilingDisc glint = draw_glint(extent, ceiling.height_m, random);
    if (std::ranges::all_of(ceiling.markers,
                            [&](const CeilingMarker& marker) { return is_off_film(glint, marker); })) {
      glints.push_back(glint);
    }
  }
  return glints;
}

}  // namespace

std::vector<CeilingMarker> hang_markers(const MarkerRegistry& registry, const SimulatedCameraOptions& options,
                                        std::uint64_t seed) {
  const Random random = Random(seed).stream(dots_of_markers);
  std::vector<CeilingMarker> markers;
  for (std::size_t i = 0; i < registry.markers.size(); ++i) {
    markers.push_back(installed_marker(registry, registry.markers[i], options, random.stream(i)));
  }
  return markers;
}

Ceiling fit_ceiling(const MarkerRegistry& registry, const SimulatedCameraOptions& options,
                    std::uint64_t seed) {
  const Random random(seed);
  Ceiling ceiling;
  ceiling.markers = hang_markers(registry, options, seed);
  ceiling.height_m = median_height_m(ceiling.markers);
  ceiling.tile_corner_m = draw_tile_corner(random.stream(place_of_tiles));
  const Extent extent = extent_of(ceiling.markers);
  if (options.ceiling == CeilingKind::reflectors) {
    ceiling.tubes = fit_reflectors(ceiling, extent);
  } else if (options.tubes) {
    ceiling.tubes = fit_tubes(ceiling, extent);
  }
  if (options.lamps) ceiling.lamps = fit_lamps(ceiling, extent, random.stream(places_of_lamps));
  if (options.glints) ceiling.glints = scatter_glints(ceiling, extent, random.stream(places_of_glints));
  return ceiling;
}

}  // namespace lodestar
