#include "maps/standing_rays.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "maps/grazed_surface.hpp"
#include "maps/scan_pieces.hpp"

namespace lodestar {
namespace {

class StandingRays {
 public:
  StandingRays(const DeskewedScan& scan, const ObstacleMemory& memory, const StandingRaysOptions& options)
      : scan_(scan), memory_(memory), options_(options), stands_(scan.rays.size(), false) {}

  void add_where_hit(const ScanPiece& thing) {
    ScanPiece stood;  // each by itself
    for (const std::size_t i : thing)
      if (memory_.stands_at(scan_.rays[i].end_m, scan_.newest)) stood.push_back(i);
    if (!is_good_part(stood.size(), thing)) return;
    for (const std::size_t i : stood) stands_[i] = true;
    for (const std::size_t i : thing) {
      const Vec2& end_m = scan_.rays[i].end_m;
      stands_[i] =
          stands_[i] || (!memory_.has_come_to(end_m) && std::ranges::any_of(stood, [&](std::size_t k) {
            return (scan_.rays[k].end_m - end_m).norm() <= options_.shows_m;
          }));
    }
  }

  /// Along a wall that they graze rays end far apart, and in other cells in each scan. Where what stands
  /// leads on, away from the scanner, it stands too, unless someone has come there.
  void add_along(const ScanPiece& thing, GrazedSurface& surface) {
    ScanPiece led_to;
    std::size_t standing = 0;
    for (const std::size_t i : thing) {
      const Ray& ray = scan_.rays[i];
      const bool leads = !stands_[i] && surface.leads_to(ray) && !memory_.has_come_to(ray.end_m);
      if (leads) led_to.push_back(i);
      if (stands_[i] || leads) {
        ++standing;
        surface.add(ray.end_m);
      } else {
        surface.end();
      }
    }
    if (!is_good_part(standing, thing) || !are_grazing(scan_, led_to)) return surface.end();
    for (const std::size_t i : led_to) stands_[i] = true;
  }

  [[nodiscard]] std::vector<bool> found() && { return std::move(stands_); }

 private:
  [[nodiscard]] bool is_good_part(std::size_t rays, const ScanPiece& of) const {
    return static_cast<double>(rays) >= options_.standing_share * static_cast<double>(of.size());
  }

  const DeskewedScan& scan_;
  const ObstacleMemory& memory_;
  const StandingRaysOptions& options_;
  std::vector<bool> stands_;
};

}  // namespace

std::vector<bool> rays_at_what_stands(const DeskewedScan& scan, const ObstacleMemory& memory,
                                      const StandingRaysOptions& options) {
  const auto joins = [&](const Ray& before, const Ray& ray) {
    return (ray.end_m - before.end_m).norm() <= options.joins_m;
  };
  const std::vector<ScanPiece> things = pieces_of(scan, ends_at_something, joins);
  StandingRays standing(scan, memory, options);
  for (const ScanPiece& thing : things) standing.add_where_hit(thing);
  GrazedSurface to_left;
  for (const ScanPiece& thing : things) standing.add_along(thing, to_left);
  GrazedSurface to_right;
  for (std::size_t i = things.size(); i-- > 0;)
    standing.add_along(ScanPiece(things[i].rbegin(), things[i].rend()), to_right);
  return std::move(standing).found();
}

}  // namespace lodestar
