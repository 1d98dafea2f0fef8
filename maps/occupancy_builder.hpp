#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "maps/occupancy_map.hpp"
#include "maps/scan.hpp"

namespace lodestar {

struct OccupancyBuilderOptions {
  double resolution_m = 0.05;
  /// What one scan says of a cell: that something is there with probability 0.7, where a beam ends in it, and
  /// with 0.4, where beams pass through it (Hornung et al. 2013, OctoMap's values for laser scanners).
  double hit_log_odds = 0.847;
  double miss_log_odds = -0.405;
  /// So much can be forgotten again: what stood there in hundreds of scans is gone after as many without.
  double most_log_odds = 200.0;
  /// Surer than 0.7 that it is free, or that it is occupied: two scans that pass, two that end.
  double free_log_odds = -0.8;
  double occupied_log_odds = 1.6;
  /// Things are solid behind the surface that a beam meets. So far behind it, in cells, the evidence is
  /// written: 2 cm, twice the noise of range and pose, so that a wall on a border of cells does not grow into
  /// the free cell before it.
  double depth_cells = 0.4;
  /// Farther hits clear their way up to here and are then left out: at 0.1 degrees, an error of 2 cm.
  double max_range_m = 12.0;
  /// Without an echo, a beam clears so far: dark things at hand return one, far ones may not.
  double clears_without_echo_m = 3.0;
  std::size_t most_cells = 64U << 20U;  ///< of the grid: 400 m x 400 m at 5 cm, 0.8 GB
};

/// An occupancy grid from scans whose poses are known: log-odds ray casting with an inverse sensor model
/// (Moravec and Elfes 1985; Thrun, Burgard and Fox 2005, table 9.1). The grid grows as scans need it; its
/// cells are aligned with the map frame.
class OccupancyBuilder {
 public:
  explicit OccupancyBuilder(const OccupancyBuilderOptions& options = {}) : options_(options) {}

  /// Adds a scan; `map_from_scanner` has one pose for each of its beams. A cell is updated once: several
  /// beams of one scan share the error of its pose. False when the grid would grow too large, as by poses
  /// that are far off; nothing is added then.
  [[nodiscard]] bool add(const Scan& scan, std::span<const Pose2> map_from_scanner);

  [[nodiscard]] std::size_t scans() const { return scans_; }

  /// The map, as large as the cells that scans have reached. Without a scan it has no cells.
  [[nodiscard]] OccupancyMap map() const;

 private:
  struct Ray {
    Vec2 from_in_grid;
    Vec2 clear_to_in_grid;
    Vec2 end_in_grid;
    bool ends = false;  ///< at something
  };
  /// What the beams of the present scan say of a cell.
  struct Evidence {
    std::uint32_t scan = 0;
    std::uint16_t hits = 0;
    std::uint16_t misses = 0;
  };

  [[nodiscard]] bool reach(const Scan& scan, std::span<const Pose2> map_from_scanner);
  void cast(const Ray& ray);
  Evidence& evidence(Cell cell);
  void commit();
  [[nodiscard]] std::size_t index(Cell cell) const;

  OccupancyBuilderOptions options_;
  Cell low_;  ///< of the grid's first cell; cell (0, 0) begins at the map's origin
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> log_odds_;
  std::vector<Evidence> evidence_;
  std::vector<std::size_t> touched_;  ///< by the present scan
  std::vector<Ray> rays_;
  std::uint32_t scans_ = 0;
};

}  // namespace lodestar
