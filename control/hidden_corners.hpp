#pragma once

#include <functional>
#include <vector>

#include "control/field_scan.hpp"
#include "maps/scan_rays.hpp"

namespace lodestar {

/// Which shadows count: only those out of which someone could step in front of the robot. What is far away is
/// seen better before the robot gets there, and what is thin hides nobody.
struct HiddenCornerOptions {
  double within_m = 2.5;       ///< of the scanner; 0: no corner counts
  double least_depth_m = 0.6;  ///< of the shadow behind the edge: a person takes 0.5 m
  /// Of what casts it, measured along what is seen of it: a person is at least 0.3 m wide, legs of chairs and
  /// tables are not.
  double least_width_m = 0.3;
  double joins_m = 0.15;  ///< neighbouring hits within this of each other are one thing
  /// Where someone would stand who steps out: so far behind the edge, so far into the shadow.
  double stands_behind_m = 0.3;
};

/// Can a person stand at this point of the rays' frame, as far as the map knows? Unknown counts as yes.
using CanStand = std::function<bool(const Vec2& point_in_odom)>;

/// The edges of the shadows that can hide a person, as points of the protective field.
std::vector<FieldPoint> hidden_corners(const DeskewedScan& scan, const HiddenCornerOptions& options,
                                       const CanStand& can_stand);

}  // namespace lodestar
