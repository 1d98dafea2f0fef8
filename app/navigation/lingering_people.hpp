#pragma once

#include <span>
#include <vector>

#include "control/field_scan.hpp"
#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

struct LingeringPeopleOptions {
  double joins_m = 0.15;         ///< neighbouring hits within this of each other are one piece
  double widest_m = 0.9;         ///< a piece of someone, with a coat and both legs
  double stays_within_m = 0.25;  ///< of its place, by the middle of what is hit: nobody stands still
  /// The place follows, as the robot sees other sides of them.
  Duration follows_in = std::chrono::seconds(10);
  /// A part of it has moved in so many of the scans lately: the edges of posts come and go in a few only.
  double walking_share = 0.2;
  Duration lately = std::chrono::seconds(3);
  Duration longest_unseen = std::chrono::milliseconds(1500);
  /// The robot is sooner there when it waits for who only pauses (chosen among crowds of both kinds).
  Duration lingers_from = std::chrono::seconds(15);
  /// Who passes by has left the place by then.
  Duration stays_from = std::chrono::seconds(3);
};

/// Who stays about one place, but not so still that they stand: people who talk, sway and shift from one leg
/// to the other. For the protective field they walk.
class LingeringPeople {
 public:
  explicit LingeringPeople(const LingeringPeopleOptions& options = {}) : options_(options) {}

  /// What the newest scan shows, in the order of its beams. Says of its points whether who is there stays.
  void add(std::span<FieldPoint> points, Stamp newest);

  /// Where they were hit last, in the odometry frame.
  [[nodiscard]] std::vector<Vec2> hits_m(Stamp now) const;

 private:
  struct Someone {
    Vec2 place_m = Vec2::Zero();
    Stamp since;
    Stamp seen;
    double moved_share = 0.0;
    std::vector<Vec2> hits_m;
  };

  void follow(std::span<FieldPoint> piece, Stamp newest);
  [[nodiscard]] Someone* nearest(const Vec2& middle_m);

  LingeringPeopleOptions options_;
  std::vector<Someone> people_;
};

}  // namespace lodestar
