#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "maps/geometry.hpp"
#include "maps/lone_posts.hpp"
#include "maps/ray_fan.hpp"
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
  /// Where the floor was seen free just before, what is hit has come by itself: someone who has stopped, and
  /// may walk on at once. So may who has legs. Chosen by hand.
  Duration to_stand_as_a_person = std::chrono::seconds(10);
  /// What fewer beams have hit in a row may be a mixed pixel beside what stands, and is nobody yet: three,
  /// and nearer than 3 m, of beams half a degree apart, half of those that hit a cell in three scans.
  int hits_to_come = 3;
  double hits_to_come_m = 8.5;  ///< this divided by the range
  /// What has come and shows no legs may be in a coat or a wheelchair, or be a robot, and go as well; what
  /// has stayed for so long was put there (chosen by hand).
  Duration to_stay = std::chrono::seconds(60);
  Duration just_before = std::chrono::seconds(3);  ///< in which a person has come, or has passed by
  /// What has not looked like a leg for so long, though it was hit from where legs can be told
  /// (LegOptions::within_m), is none: legs that pass close by a box are hit in its cells. Legs, one behind
  /// the other or beside a wall, are rarely hidden for as long.
  Duration not_a_leg_after = std::chrono::seconds(10);
  /// What has stood as a thing is no leg when it looks like one only from so near: the body that it carries
  /// would be where the robot is. From the scanner; of a robot of 25 cm, with 22 cm for the body and the
  /// leg's other side.
  double becomes_leg_from_m = 0.6;
  Duration between_looks_back = std::chrono::milliseconds(250);
  /// Seen free is a place when nothing is hit within this of it: 3 standard deviations of the range, and for
  /// each metre away what the wheels turn the odometry frame by meanwhile (up to a degree) and half of the
  /// gap between beams half a degree apart.
  double seen_free_beside_m = 0.05;
  double seen_free_beside_per_m = 0.025;
  /// All of it in so many looks, without a hit between: all beams that meet a thin thing may be mixed pixels,
  /// now and then. Farther away two or three meet it, and a dark thing's edges come and go.
  int looks_free = 2;
  double seen_free_near_m = 4.0;
  int looks_free_far = 4;
  double seen_free_within_m = 8.0;
  /// And only between two beams that are no farther from it: a degree apart, they are 7 cm apart there.
  double seen_free_between_m = 0.08;
  Duration longest_unseen =
      std::chrono::milliseconds(350);  ///< while it comes to stand: three scans at 10 Hz
  /// A thin thing where cells meet is hit in one or another by the noise of the range: each of them may miss
  /// out for so long while those beside it are hit. Who walks at more than 5 cm/s has left the cell.
  Duration longest_unseen_leg = std::chrono::seconds(1);
  /// Out of sight, what stood is remembered as long as a detour around it takes (chosen by hand), what moved
  /// as long as someone takes to leave a step's width.
  Duration remembered_standing = std::chrono::seconds(30);
  Duration remembered_moving = std::chrono::milliseconds(1500);
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

  /// Is there, here or in a cell beside it, what may be a leg?
  [[nodiscard]] bool has_legs(const Vec2& point_m) const;

  /// Was what is hit here, or in a cell beside it, seen to come? Else it may be furniture.
  [[nodiscard]] bool has_come(const Vec2& point_m) const;

  /// May what is hit here have come within the last seconds?
  [[nodiscard]] bool has_come_to(const Vec2& point_m) const;

  /// May it go as it came, since it has legs or came lately?
  [[nodiscard]] bool may_go(const Vec2& point_m) const;

  /// Where something stands, also where it has not been seen for a while: the mean of what was hit in each
  /// cell.
  [[nodiscard]] std::vector<Vec2> standing_m(Stamp now) const;

  /// The same of legs, and of what has come lately.
  [[nodiscard]] std::vector<Vec2> standing_people_m(Stamp now) const;

  /// The same of posts: they may carry a seat or the top of a table, which the scanner does not see.
  [[nodiscard]] std::vector<Vec2> standing_posts_m(Stamp now) const;

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
    Vec2 mean_m = Vec2::Zero();  ///< of the newest hits
    /// The same, each hit smoothed along the surface: a cell in front of it, that noise alone hits, would
    /// narrow a gap.
    Vec2 surface_m = Vec2::Zero();
    int hits = 0;     ///< in the mean
    Stamp first_hit;  ///< of an unbroken row of hits
    Stamp last_hit;
    std::uint8_t times_free = 0;  ///< in a row
    bool hit_now = false;
    Stamp hit_beside;  ///< last, here or in a cell beside
    /// The floor here was seen free just before then, or beside here.
    std::optional<Stamp> came_at;
    bool has_come = false;        ///< then, by more than a mixed pixel
    std::optional<Stamp> leg_at;  ///< what may be a leg was hit last
    bool is_post = false;         ///< and was none
    Stamp judged_at;              ///< hit last from where legs can be told
  };

  [[nodiscard]] Place place_of(const Vec2& point_m) const;
  [[nodiscard]] Vec2 center_m(Place place) const;
  [[nodiscard]] const Seen* at(Place place) const;
  /// A scan of a while ago.
  struct Look {
    Stamp stamp;
    Duration seeing{};  ///< seeing_ then
    Vec2 from_m;
    RayFan fan;
  };

  [[nodiscard]] bool is_leg(const Seen& seen) const;
  [[nodiscard]] bool has_stood(const Seen& seen) const;
  [[nodiscard]] bool came_lately(const Seen& seen) const;
  [[nodiscard]] bool is_part_of_a_thing(Place place) const;
  [[nodiscard]] bool was_seen_free(Place place, Stamp before) const;
  [[nodiscard]] std::optional<Stamp> came_beside_at(Place place, Stamp now) const;
  template <typename Ask>
  void ask_beside(Place middle, const Ask& ask, int reach = 1) const;
  template <typename Holds>
  [[nodiscard]] bool any_beside(const Vec2& point_m, const Holds& holds) const;
  [[nodiscard]] bool is_remembered(const Seen& seen, Stamp now) const;
  void mark_hits(const DeskewedScan& scan, const Place& middle);
  void hit(const Ray& ray, const Vec2& surface_m);
  void mark_legs(const DeskewedScan& scan, const RayFan& fan);
  void take_as_post(const LonePost& post);
  void note_hits_beside(Stamp now);
  [[nodiscard]] bool is_broken_off(const Seen& seen, Stamp now) const;
  void count_free(const DeskewedScan& scan, const RayFan& fan);
  void remember_look(const DeskewedScan& scan, RayFan fan);
  void forget(Stamp now, const Place& middle);

  ObstacleMemoryOptions options_;
  int half_cells_ = 0;
  std::vector<Seen> seen_;
  std::vector<std::int32_t> index_;  ///< of a place, wrapped around, in seen_; none where negative
  std::deque<Look> looks_;
  LonePosts posts_;
  std::optional<Stamp> last_look_;
  Duration seeing_{};  ///< for how long so far: not while the scanner was silent or most beams were lost
};

}  // namespace lodestar
