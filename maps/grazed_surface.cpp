#include "maps/grazed_surface.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

bool GrazedSurface::leads_to(const Ray& ray) const {
  if (ends_m_.empty()) return false;
  const Vec2& last_m = ends_m_.back();
  const auto is_far = [&](const Vec2& end_m) { return (last_m - end_m).norm() >= options_.least_length_m; };
  const auto from = std::find_if(ends_m_.rbegin(), ends_m_.rend(), is_far);
  if (from == ends_m_.rend()) return false;
  const Vec2 way = (last_m - *from).normalized();
  const Vec2 step = ray.end_m - last_m;
  const bool is_grazed = way.dot(ray.end_m - ray.origin_m) >= options_.least_cosine * range_m(ray);
  return is_grazed && step.norm() <= options_.joins_m && way.dot(step) >= -options_.off_m &&
         std::abs(cross(way, step)) <= options_.off_m;
}

void GrazedSurface::add(const Vec2& end_m) {
  if (!ends_m_.empty() && (ends_m_.back() - end_m).norm() > options_.joins_m) end();
  ends_m_.push_back(end_m);
}

bool are_grazing(const DeskewedScan& scan, std::span<const std::size_t> rays) {
  constexpr double least_ratio = 2.0;  // met at 27 degrees; grazed at less than 14, it is 4 at least
  if (rays.size() < 2) return true;
  const auto away_m = [&](std::size_t i) { return range_m(scan.rays[i]); };
  const Ray& first = scan.rays[rays.front()];
  const Ray& last = scan.rays[rays.back()];
  const double wide_m =
      std::abs(cross(first.end_m - first.origin_m, last.end_m - last.origin_m)) / range_m(first);
  const auto [nearest, farthest] = std::ranges::minmax_element(rays, {}, away_m);
  return away_m(*farthest) - away_m(*nearest) >= least_ratio * wide_m;
}

}  // namespace lodestar
