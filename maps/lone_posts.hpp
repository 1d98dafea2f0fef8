#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "maps/occupancy_map.hpp"
#include "maps/ray_fan.hpp"
#include "maps/scan_rays.hpp"

namespace lodestar {

struct LonePostsOptions {
  double cell_m = 0.025;
  /// Between the middles of two legs on which someone stands, or a chair. Those of a stride are farther
  /// apart, but who makes one has come.
  double farthest_leg_m = 0.3;
  /// The thing's own hits lie so far around it: 3 standard deviations of the range (4.5 cm), half the
  /// diagonal of a cell, and what few beams show of its width less than there is.
  double own_m = 0.07;
  /// A ray that passes so close to where the middle of a leg is would hit it: a leg is at least 10 cm thick,
  /// less half the diagonal of a cell.
  double would_hit_m = 0.03;
  double before_end_m = 0.05;  ///< a ray that ends so soon behind a place has not passed it
  /// In the odometry frame, which drifts meanwhile by some centimetres (chosen by hand).
  Duration places_remembered = std::chrono::seconds(120);
  Duration posts_remembered = std::chrono::seconds(30);  ///< as what stands (ObstacleMemoryOptions)
  Duration between_looks = std::chrono::seconds(1);      ///< at a place that was free
  int times_alone = 3;  ///< seen so, it is a post: the noise of one scan makes none
  /// A post stays for so long within this: what is pushed along at more than 4 cm/s is none. Its middle is
  /// guessed from the side that is seen, to within some centimetres.
  Duration to_stay = std::chrono::seconds(2);
  double stays_within_m = 0.08;
  /// What is hit again within this is there, and no mixed pixel beside an edge: three scans at 10 Hz.
  Duration hit_again = std::chrono::milliseconds(350);
};

/// A thing as thin as a leg beside which there is no second one.
struct LonePost {
  Vec2 middle_m;
  double reach_m = 0.0;  ///< its own hits are no farther from there
};

/// Tells posts from legs: wherever the second leg of a person or of a chair could be beside a thin thing, a
/// ray has passed. From one side the thing hides some of these places; they come into sight as the robot
/// drives on. Two posts as close to each other as legs stay legs.
class LonePosts {
 public:
  explicit LonePosts(const LonePostsOptions& options = {});

  /// The posts among the things at which the rays `at_legs` end. `fan`: of the scan. Frame: that of the rays,
  /// the same for all scans.
  std::vector<LonePost> add(const DeskewedScan& scan, const RayFan& fan,
                            std::span<const std::size_t> at_legs);

 private:
  struct Place {
    Cell cell;
    std::optional<Stamp> free_at;  ///< a ray passed here last, and nothing was hit since
    std::optional<Stamp> hit_at;
  };
  /// Of all places of a second leg: each has been seen free, one is hit now, or neither.
  enum class Beside : std::uint8_t { free, taken, unknown };
  /// A thin thing.
  struct Known {
    Vec2 middle_m;
    Stamp since;     ///< it is here
    Stamp alone_at;  ///< it was seen alone last, or came to be known
    int times_alone = 0;
  };

  [[nodiscard]] Place& place_at(Cell cell);
  void note_hits(const DeskewedScan& scan);
  [[nodiscard]] bool is_free(Place& place, Stamp now, const RayFan& fan) const;
  [[nodiscard]] Beside beside(const LonePost& thing, Stamp now, const RayFan& fan);
  [[nodiscard]] Known& known_at(const Vec2& middle_m, Stamp now);
  [[nodiscard]] bool is_alone(const LonePost& thing, Stamp now, const RayFan& fan);

  LonePostsOptions options_;
  std::vector<Place> places_;  ///< by their cell, wrapped around
  std::vector<Known> known_;
};

}  // namespace lodestar
