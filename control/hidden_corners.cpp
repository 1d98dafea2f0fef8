#include "control/hidden_corners.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

namespace lodestar {
namespace {

/// How far the scanner sees along the ray; nothing where it does not know.
std::optional<double> seen_m(const Ray& ray) {
  if (ray.echo == Echo::invalid) return std::nullopt;
  return range_m(ray);
}

/// The scan as a ring: its last beam is beside its first. A gap between neighbours is not looked across.
class Ring {
 public:
  Ring(const DeskewedScan& scan, const HiddenCornerOptions& options) : scan_(&scan), options_(&options) {}

  [[nodiscard]] const Ray& at(std::ptrdiff_t i) const {
    const auto count = static_cast<std::ptrdiff_t>(scan_->rays.size());
    return scan_->rays[static_cast<std::size_t>((i % count + count) % count)];
  }

  /// Does the thing that ends at `i` extend far enough to hide a person, going on by `step`?
  [[nodiscard]] bool is_wide(std::ptrdiff_t i, std::ptrdiff_t step) const {
    const Vec2 edge_m = at(i).end_m;
    const auto count = static_cast<std::ptrdiff_t>(scan_->rays.size());
    Vec2 last_m = edge_m;
    for (std::ptrdiff_t k = 1; k < count; ++k) {
      const Ray& ray = at(i + k * step);
      if (ray.echo == Echo::invalid) continue;
      if (!ends_at_something(ray) || (ray.end_m - last_m).norm() > options_->joins_m) return false;
      last_m = ray.end_m;
      if ((last_m - edge_m).norm() >= options_->least_width_m) return true;
    }
    return false;
  }

  /// The nearest ray from `i` on, by `step`, that knows something; it must look almost the same way.
  [[nodiscard]] const Ray* beside(std::ptrdiff_t i, std::ptrdiff_t step) const {
    constexpr std::ptrdiff_t most_lost = 3;
    for (std::ptrdiff_t k = 1; k <= most_lost; ++k)
      if (at(i + k * step).echo != Echo::invalid) return &at(i + k * step);
    return nullptr;
  }

 private:
  const DeskewedScan* scan_;
  const HiddenCornerOptions* options_;
};

}  // namespace

std::vector<FieldPoint> hidden_corners(const DeskewedScan& scan, const HiddenCornerOptions& options,
                                       const CanStand& can_stand) {
  constexpr double same_way_cosine = 0.995;  // neighbours are at most 6 degrees apart
  std::vector<FieldPoint> corners;
  const Ring ring(scan, options);
  const auto count = static_cast<std::ptrdiff_t>(scan.rays.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Ray& edge = ring.at(i);
    const std::optional<double> near_m = seen_m(edge);
    if (edge.echo != Echo::hit || !near_m || *near_m > options.within_m) continue;
    const Vec2 way = (edge.end_m - edge.origin_m) / *near_m;
    for (const std::ptrdiff_t step : {std::ptrdiff_t{-1}, std::ptrdiff_t{1}}) {
      const Ray* const open = ring.beside(i, step);
      if (open == nullptr || open == &edge) continue;
      const std::optional<double> far_m = seen_m(*open);
      if (!far_m || *far_m < *near_m + options.least_depth_m) continue;
      const Vec2 open_way = (open->end_m - open->origin_m) / *far_m;
      if (open_way.dot(way) < same_way_cosine || !ring.is_wide(i, -step)) continue;
      // Into the shadow: to the side of what casts it.
      const Vec2 across(-way.y(), way.x());
      const double side = cross(way, open_way) > 0.0 ? -1.0 : 1.0;
      const Vec2 stand_m = edge.end_m + options.stands_behind_m * (way + side * across);
      if (can_stand(stand_m)) corners.push_back({edge.stamp, edge.end_m, Presence::hidden});
    }
  }
  return corners;
}

}  // namespace lodestar
