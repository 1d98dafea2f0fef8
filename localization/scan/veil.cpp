#include "localization/scan/veil.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace lodestar {
namespace {

/// From the first ray's direction to the second's, seen from the scanner, without a sign.
double between_rad(const Ray& a, const Ray& b) {
  const Vec2 from = a.end_m - a.origin_m;
  const Vec2 to = b.end_m - b.origin_m;
  return std::abs(std::atan2(cross(from, to), from.dot(to)));
}

/// The rays of a turn, in a ring.
class Ring {
 public:
  Ring(const DeskewedScan& scan, const VeilOptions& options) : rays_(scan.rays), options_(options) {}

  /// Is it a hit that one beam alone, or two that are not of one thing, show where a leg would take several?
  [[nodiscard]] bool is_veil(std::size_t i) const {
    if (at(i).echo != Echo::hit) return false;
    const std::size_t here = i + rays_.size();  // so that there are some before it
    const std::size_t first = joins(here - 1) ? here - 1 : here;
    const std::size_t last = joins(here) ? here + 1 : here;
    if (last - first > 1 || joins(first - 1) || joins(last)) return false;
    const double depth_m = std::abs(range_m(at(last)) - range_m(at(first)));
    if (last > first && depth_m < options_.depth_m) return false;
    const auto beams = static_cast<double>(last - first + 1);
    return beams * across_m(i) * options_.least_beams <= options_.least_width_m;
  }

 private:
  [[nodiscard]] const Ray& at(std::size_t i) const { return rays_[i % rays_.size()]; }

  /// Is the next one's hit of the same thing?
  [[nodiscard]] bool joins(std::size_t i) const {
    return ends_at_something(at(i)) && ends_at_something(at(i + 1)) &&
           (at(i + 1).end_m - at(i).end_m).norm() <= options_.joins_m;
  }

  /// What is between two beams there.
  [[nodiscard]] double across_m(std::size_t i) const {
    return range_m(at(i)) * 0.5 * between_rad(at(i + rays_.size() - 1), at(i + 1));
  }

  const std::vector<Ray>& rays_;
  const VeilOptions& options_;
};

}  // namespace

DeskewedScan without_veils(DeskewedScan scan, const VeilOptions& options) {
  const std::size_t count = scan.rays.size();
  if (count < 3) return scan;
  const Ring ring(scan, options);
  std::vector<std::size_t> veils;
  for (std::size_t i = 0; i < count; ++i)
    if (ring.is_veil(i)) veils.push_back(i);
  for (const std::size_t i : veils) scan.rays[i].echo = Echo::invalid;
  return scan;
}

}  // namespace lodestar
