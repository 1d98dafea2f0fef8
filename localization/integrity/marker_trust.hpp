#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "maps/geometry.hpp"

namespace lodestar {

struct MarkerTrustOptions {
  int witnesses = 2;                   ///< other markers that must agree with the estimate, before and after
  int contradictions_to_distrust = 6;  ///< confirmed contradictions, since it last agreed
  double tolerated_offset_m = 0.03;    ///< smaller displacements may be survey errors
  double tolerated_turn_rad = radians(3.0);
  std::size_t remembered_witnesses = 6;  ///< latest markers that agreed
};

/// A marker displaced from its survey.
struct DistrustedMarker {
  int id = 0;
  Vec2 offset_m = Vec2::Zero();  ///< of its dot O from its registered position, in the map frame
  double turn_rad = 0.0;         ///< of its orientation, counter-clockwise
  int fixes = 0;                 ///< confirmed contradictions
  double sigma_m = 0.0;          ///< of the offset, along each axis
  double sigma_rad = 0.0;
};

/// Fix of one marker alone, with the estimate's prediction.
struct MarkerSighting {
  int id = 0;
  Vec2 marker_in_map = Vec2::Zero();  ///< as surveyed
  Pose2 map_from_base_by_marker;
  Pose2 map_from_base_expected;
  double squared_distance = 0.0;  ///< between the two, Mahalanobis with 3 degrees of freedom
};

/// Detects markers displaced from their survey. A marker is charged when its fix contradicts an estimate that
/// others agreed with before; the charge is confirmed once others agree with the estimate afterwards too. So
/// wheel slip, a carried robot or one other displaced marker does not accuse a healthy one. A value type.
class MarkerTrust {
 public:
  explicit MarkerTrust(const MarkerTrustOptions& options = {}) : options_(options) {}

  /// Adds a fix of one marker alone. Fixes that agree with the estimate belong to add_agreement() instead.
  void add_contradiction(const MarkerSighting& sighting);

  /// Adds a fix by these markers, together, that agrees with the estimate.
  void add_agreement(std::span<const int> ids);

  /// Distrusts a marker from now on, as an earlier drive found.
  void distrust(const DistrustedMarker& marker);

  /// The estimate was wrong, or the robot was placed anew: discards the unconfirmed charges, and the
  /// witnesses for the estimate.
  void estimate_moved();

  [[nodiscard]] bool trusts(int id) const;

  /// By ascending ID.
  [[nodiscard]] std::vector<DistrustedMarker> distrusted() const;

 private:
  /// Sums over the contradictions against one marker.
  struct Contradictions {
    int count = 0;
    Vec3 offset_sum = Vec3::Zero();  ///< x_m, y_m, yaw_rad
    Vec3 square_sum = Vec3::Zero();
    void add(const Vec3& offset);
    void add(const Contradictions& more);
    [[nodiscard]] Vec3 mean() const { return offset_sum / std::max(count, 1); }
    [[nodiscard]] Vec3 sigma() const;
  };
  struct Suspect {
    Contradictions open;            ///< unconfirmed: too few others have agreed with the estimate since
    std::vector<int> confirmed_by;  ///< markers that have agreed since
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
