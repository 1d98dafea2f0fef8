#include "maps/smoothed_ends.hpp"

namespace lodestar {

std::vector<Vec2> smoothed_ends_m(const DeskewedScan& scan, const SmoothingOptions& options) {
  const std::vector<Ray>& rays = scan.rays;
  std::vector<Vec2> ends_m;
  ends_m.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Vec2 sum_m = rays[i].end_m;
    int count = 1;
    const auto add_towards = [&](int step) {
      for (int k = 1; k <= options.neighbours; ++k) {
        const std::size_t next = i + static_cast<std::size_t>(k * step);  // wraps below 0 to beyond the end
        if (next >= rays.size() || rays[next].echo != Echo::hit) return;
        const std::size_t last = next - static_cast<std::size_t>(step);
        if ((rays[next].end_m - rays[last].end_m).norm() > options.joins_m) return;
        sum_m += rays[next].end_m;
        ++count;
      }
    };
    if (rays[i].echo == Echo::hit) {
      add_towards(1);
      add_towards(-1);
    }
    ends_m.emplace_back(sum_m / count);
  }
  return ends_m;
}

}  // namespace lodestar
