#include "localization/scan/veil.hpp"

#include <cmath>

namespace lodestar {
namespace {

/// From the first ray's direction to the second's, seen from the scanner, without a sign.
double between_rad(const Ray& a, const Ray& b) {
  const Vec2 from = a.end_m - a.origin_m;
  const Vec2 to = b.end_m - b.origin_m;
  return std::abs(std::atan2(cross(from, to), from.dot(to)));
}

}  // namespace

DeskewedScan without_veils(DeskewedScan scan, const VeilOptions& options) {
  const std::size_t count = scan.rays.size();
  if (count < 3) return scan;
  std::vector<std::size_t> veils;
  for (std::size_t i = 0; i < count; ++i) {
    const Ray& ray = scan.rays[i];
    if (ray.echo != Echo::hit) continue;
    const Ray& before = scan.rays[(i + count - 1) % count];
    const Ray& after = scan.rays[(i + 1) % count];
    const auto joins = [&](const Ray& beside) {
      return ends_at_something(beside) && (beside.end_m - ray.end_m).norm() <= options.joins_m;
    };
    if (joins(before) || joins(after)) continue;
    const double across_m = range_m(ray) * 0.5 * between_rad(before, after);
    if (across_m * options.least_beams <= options.least_width_m) veils.push_back(i);
  }
  for (const std::size_t i : veils) scan.rays[i].echo = Echo::invalid;
  return scan;
}

}  // namespace lodestar
