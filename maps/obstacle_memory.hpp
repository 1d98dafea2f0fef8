#pragma once

#include <cstdint>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/scan_rays.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

struct ObstacleMemoryOptions {
  double cell_m = 0.05;
  double half_extent_m = 12.0;  ///< of the square around the robot; at most 255 cells
  /// Rays clear up to this far before their end: 3 standard deviations of the range (1.5 cm) and half the
  /// diagonal of a cell.
  double kept_before_end_m = 0.08;
  int scans_to_clear = 2;                       ///< in a row, seen free and not hit
  Duration to_stand = std::chrono::seconds(1);  ///< hit for so long, it stands
  Duration longest_unseen =
      std::chrono::milliseconds(350);  ///< while it comes to stand: three scans at 10 Hz
  /// Out of sight, what stood is remembered as long as a detour around it takes (chosen by hand), what moved
  /// as long as someone takes to leave a step's width.
  Duration remembered_standing = std::chrono::seconds(30);
  Duration remembered_moving = std::chrono::milliseconds(1500);
  double joins_m = 0.15;        ///< neighbouring hits within this of each other are one thing
  double standing_share = 0.6;  ///< of a thing's hits, for any of them to count as standing
  /// What comes into sight of a thing as the robot goes around it, within a second: so far from what has
  /// stood it is the same thing.
  double shows_m = 0.3;
};

/// What the scanner has seen around the robot: a rolling grid in the odometry frame, of which only the cells
/// that hold something are visited. A cell that rays pass through twice is free again, also where it had
/// stood.
class ObstacleMemory {
 public:
  explicit ObstacleMemory(const ObstacleMemoryOptions& options = {});

  /// The scan's rays clear, its hits are remembered. Frame of everything here: that of the rays.
  void add(const DeskewedScan& scan);

  /// Has something been hit here, or in a cell beside it, for a second in nearly every scan that could see
  /// it?
  [[nodiscard]] bool stands_at(const Vec2& point_m, Stamp now) const;

  /// For each ray of the newest scan: does it end at something that stands? Of what is hit in one piece a
  /// good part must stand: the flank of someone who walks across stays in the same cells for a while.
  [[nodiscard]] std::vector<bool> standing(const DeskewedScan& scan) const;

  /// Centres of the cells in which something stands, also where it has not been seen for a while.
  [[nodiscard]] std::vector<Vec2> standing_m(Stamp now) const;

  /// Centres of the cells that are hit now or remembered.
  [[nodiscard]] std::vector<Vec2> occupied_m(Stamp now) const;

 private:
  struct Place {
    int column = 0;
    int row = 0;
    friend bool operator==(const Place&, const Place&) = default;
  };
  struct Seen {
    Place place;
    Stamp first_hit;  ///< of an unbroken row of hits
    Stamp last_hit;
    std::uint8_t times_free = 0;  ///< in a row
    bool hit_now = false;
  };

  [[nodiscard]] Place place_of(const Vec2& point_m) const;
  [[nodiscard]] Vec2 center_m(Place place) const;
  [[nodiscard]] const Seen* at(Place place) const;
  [[nodiscard]] bool has_stood(const Seen& seen) const;
  [[nodiscard]] bool is_remembered(const Seen& seen, Stamp now) const;
  void mark_hits(const DeskewedScan& scan, const Place& middle);
  void hit(Place place, Stamp stamp);
  void count_free(const DeskewedScan& scan);
  void forget(Stamp now, const Place& middle);

  ObstacleMemoryOptions options_;
  int half_cells_ = 0;
  std::vector<Seen> seen_;
  std::vector<std::int32_t> index_;  ///< of a place, wrapped around, in seen_; none where negative
};

}  // namespace lodestar
