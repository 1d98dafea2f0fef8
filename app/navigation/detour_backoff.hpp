#pragma once

#include <optional>

#include "maps/geometry.hpp"
#include "maps/stamp.hpp"

namespace lodestar {

/// All chosen by hand.
struct DetourBackoffOptions {
  Duration least = std::chrono::seconds(1);
  /// As long as a robot takes to turn round at 0.5 rad/s and to set off.
  Duration most = std::chrono::seconds(8);
  double comes_on_m = 0.3;  ///< farther than this from where it was, it has come on
};

/// How often the robot may change its way because something stands in it. What is seen from near and from
/// afar, and the noise of the range, open and shut narrow ways by turns: a robot that changed its way each
/// second would turn to and fro and never try one. So each change that has led nowhere doubles the time until
/// the next (exponential backoff); meanwhile the protective field alone holds the robot.
class DetourBackoff {
 public:
  explicit DetourBackoff(const DetourBackoffOptions& options = {})
      : options_(options), wait_(options.least) {}

  [[nodiscard]] bool may_change(Stamp now) const { return !last_ || now - *last_ >= wait_; }

  /// The way was changed, by a robot that is here.
  void changed(Stamp now, const Vec2& robot_m);

 private:
  DetourBackoffOptions options_;
  Duration wait_;  ///< after the last change
  std::optional<Stamp> last_;
  std::optional<Vec2> from_m_;  ///< where the first of those was that have led nowhere
};

}  // namespace lodestar
