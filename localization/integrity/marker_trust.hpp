#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

struct MarkerTrustOptions {
  int witnesses = 2;                   ///< other markers that must agree with the estimate, before and after
  int contradictions_to_distrust = 6;  ///< confirmed contradictions, agreements deducted
  double tolerated_offset_m = 0.03;    ///< a marker surveyed no worse than this is never accused
  double tolerated_turn_rad = radians(3.0);
  std::size_t remembered_witnesses = 6;  ///< the markers that agreed last
};

/// A marker that hangs elsewhere than surveyed.
struct DistrustedMarker {
  int id = 0;
  Vec2 offset_m = Vec2::Zero();  ///< of its dot O from where the registry has it, in the map frame
  double turn_rad = 0.0;         ///< of its direction, counter-clockwise
  int fixes = 0;                 ///< that speak against it
};

/// What the fix of one marker alone says, beside what the estimate expected.
struct MarkerSighting {
  int id = 0;
  Vec2 marker_in_map = Vec2::Zero();  ///< as surveyed
  Pose2 map_from_base_by_marker;
  Pose2 map_from_base_expected;
  double squared_distance = 0.0;  ///< of the two, Mahalanobis with 3 degrees of freedom
};

/// Finds out which markers no longer hang where they were surveyed. A marker is charged when its fix
/// contradicts an estimate that others agreed with before; the charge counts once others agree with the
/// estimate afterwards too. So neither a slipping wheel, nor a robot that was carried away, nor one other
/// marker that moved puts the blame on a healthy one. A value type.
class MarkerTrust {
 public:
  explicit MarkerTrust(const MarkerTrustOptions& options = {}) : options_(options) {}

  /// What one marker alone says. Fixes that agree with the estimate belong to add_agreement() instead.
  void add_contradiction(const MarkerSighting& sighting);

  /// These markers, together, agree with the estimate.
  void add_agreement(std::span<const int> ids);

  /// The estimate was wrong: no open charge stands, nor what witnesses said for it.
  void estimate_moved();

  [[nodiscard]] bool trusts(int id) const;

  /// By ascending ID.
  [[nodiscard]] std::vector<DistrustedMarker> distrusted() const;

 private:
  /// Sums over the contradictions against one marker.
  struct Contradictions {
    int count = 0;
    Vec3 offset_sum = Vec3::Zero();  ///< x_m, y_m, yaw_rad
  };
  struct Suspect {
    Contradictions open;            ///< too few others have agreed with the estimate since
    std::vector<int> confirmed_by;  ///< those that have
    Contradictions confirmed;
    bool distrusted = false;
  };

  [[nodiscard]] int witnesses_beside(int id) const;
  [[nodiscard]] bool is_elsewhere(const Contradictions& contradictions) const;
  void confirm(Suspect& suspect, std::span<const int> ids);

  MarkerTrustOptions options_;
  std::map<int, Suspect> suspects_;
  std::vector<int> witnesses_;  ///< distinct, the newest last
};

}  // namespace lodestar
