#include "control/protective_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace lodestar {
namespace {

constexpr int halvings = 6;  ///< the share is found to 1/64, from below

BodyVelocity operator*(double share, const BodyVelocity& velocity) {
  return {share * velocity.forward_mps, share * velocity.turn_radps};
}

FieldReason reason_for(Presence presence) {
  switch (presence) {
    case Presence::legs:
    case Presence::waiting:
    case Presence::person:
      return FieldReason::person_near;
    case Presence::hidden:
      return FieldReason::hidden_corner;
    case Presence::mapped:
    case Presence::standing:
      break;
  }
  return FieldReason::obstacle_ahead;
}

/// So much longer than a robot that drives up to someone it takes one that turns away to be at rest.
double turning_longer_s(const ProtectiveFieldOptions& options) {
  return options.turn_away_radps / options.turn_deceleration_radps2;
}

}  // namespace

std::string_view to_string(FieldReason reason) {
  switch (reason) {
    case FieldReason::person_near:
      return "person near";
    case FieldReason::obstacle_ahead:
      return "obstacle ahead";
    case FieldReason::hidden_corner:
      return "hidden corner";
    case FieldReason::no_scan:
      break;
  }
  return "no scan";
}

ProtectiveField::ProtectiveField(RobotShape shape, const ProtectiveFieldOptions& options)
    : shape_(std::move(shape)), options_(options) {}

double ProtectiveField::reach_m(Presence presence, double time_s) const {
  const auto from_rest_m = [&](double start_mps2) {
    return std::min(options_.person_mps * time_s, 0.5 * start_mps2 * square(time_s));
  };
  switch (presence) {
    case Presence::mapped:
      return 0.0;
    case Presence::standing:
      return from_rest_m(options_.start_mps2);
    case Presence::legs:
      return from_rest_m(options_.legs_start_mps2);
    case Presence::waiting:
      return from_rest_m(options_.waiting_start_mps2);
    case Presence::person:
      return options_.person_mps * time_s;
    case Presence::hidden:
      break;
  }
  return options_.hidden_mps * time_s;
}

double ProtectiveField::margin_m(Presence presence) const {
  switch (presence) {
    case Presence::mapped:
      return options_.mapped_margin_m;
    case Presence::standing:
      return options_.standing_margin_m;
    case Presence::legs:
    case Presence::waiting:
      return options_.body_margin_m;
    case Presence::person:
      return options_.swing_m;
    case Presence::hidden:
      break;
  }
  return 0.0;
}

/// Time for that, towards who stays: driven up to the last centimetre the robot could not turn there, for as
/// long as they do.
double ProtectiveField::turning_away_s(const BrakingPath& path, const FieldHit& hit) const {
  constexpr double towards = 0.5;  // within 60 degrees
  if (!hit.stays || is_still(hit.presence) || path.is_turn()) return 0.0;
  const double nearer_m = shape_.distance_m(hit.point_in_base) -
                          shape_.distance_m(inverse(path.steps().back().end) * hit.point_in_base);
  if (nearer_m <= towards * path.travel_m()) return 0.0;
  return turning_longer_s(options_);
}

/// Nothing farther away than this can limit: all ways and times are longest at the faster of both velocities.
double ProtectiveField::within_m(const BodyVelocity& measured, const BodyVelocity& wanted) const {
  const BrakingPath path(measured, wanted, shape_, options_);
  const double age_s = 2.0 * seconds(options_.max_scan_age) +  // of the oldest beam of the oldest scan
                       turning_longer_s(options_);
  return shape_.outer_radius_m() + path.travel_m() + options_.swing_m +
         std::max(options_.person_mps, options_.hidden_mps) * (age_s + path.until_rest_s());
}

FieldLimit ProtectiveField::limit(const std::optional<FieldScan>& scan, Stamp now,
                                  const Pose2& odom_from_base, const BodyVelocity& measured,
                                  const BodyVelocity& wanted) const {
  if (!scan || now - scan->newest > options_.max_scan_age)
    return {.share = 0.0, .reason = FieldReason::no_scan, .nearest = std::nullopt};
  return limit(seen_from(odom_from_base, now, *scan, within_m(measured, wanted)), measured, wanted);
}

/// Before a corner the robot slows to the contact speed and no further: who may be there has not been seen.
double ProtectiveField::least_share(const FieldHit& hit, const BodyVelocity& wanted) const {
  if (hit.presence != Presence::hidden) return 0.0;
  return std::min(options_.hidden_contact_mps / outline_speed_mps(wanted, shape_), 1.0);
}

/// Each hit lowers the share as far as it must. A slower robot is later at the same place, so the hits before
/// are asked again until all agree.
FieldLimit ProtectiveField::limit(std::span<const FieldHit> hits, const BodyVelocity& measured,
                                  const BodyVelocity& wanted) const {
  FieldLimit result;
  BrakingPath path(measured, wanted, shape_, options_);
  if (path.steps().empty()) return result;
  std::vector<double> distances_m(hits.size());
  double least_room_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hits.size(); ++i) {
    distances_m[i] = shape_.distance_m(hits[i].point_in_base);
    if (is_still(hits[i].presence)) least_room_m = std::min(least_room_m, distances_m[i]);
  }
  const auto is_safe_at = [&](double share, std::size_t i) {
    return is_safe(BrakingPath(measured, share * wanted, shape_, options_), hits[i], distances_m[i],
                   least_room_m);
  };
  for (bool has_changed = true; has_changed && result.share > 0.0;) {
    has_changed = false;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      double safe = least_share(hits[i], wanted);
      if (result.share <= safe || is_safe(path, hits[i], distances_m[i], least_room_m)) continue;
      double unsafe = result.share;
      for (int halving = 0; halving < halvings; ++halving) {
        const double middle = 0.5 * (safe + unsafe);
        (is_safe_at(middle, i) ? safe : unsafe) = middle;
      }
      result = {safe, reason_for(hits[i].presence), hits[i]};
      if (safe == 0.0) return result;
      path = BrakingPath(measured, safe * wanted, shape_, options_);
      has_changed = true;
    }
  }
  return result;
}

bool ProtectiveField::is_safe(const BrakingPath& path, const FieldHit& hit, double distance_m,
                              double least_room_m) const {
  const double margin = margin_m(hit.presence);
  const double after_s = hit.age_s + turning_away_s(path, hit);
  const double most_m = path.travel_m() + reach_m(hit.presence, after_s + path.until_rest_s()) + margin;
  if (distance_m > most_m) return true;
  if (!is_still(hit.presence)) return rests_in_time(path, hit, after_s);
  // Up to the creeping speed, what stands is passed like what is mapped.
  const bool is_passed = hit.presence == Presence::mapped || path.speed_mps() <= options_.standing_creep_mps;
  if (!is_passed) return rests_in_time(path, hit, after_s);
  const double slack_m = options_.slack_share * path.travel_m();
  switch (hit.presence) {
    case Presence::legs:
      // It came there before that looked like legs, and must get away: off, past what is beside it and
      // behind, or on the spot. Only a command to drive could bring it nearer step by step: no slack.
      if (distance_m < options_.body_m) return stays_clear(path, hit, distance_m - drift_beside_m(hit));
      return stays_clear(path, hit, std::max(options_.body_m, std::min(margin, distance_m) - slack_m));
    case Presence::standing: {
      const double room_m = std::max(options_.least_standing_m, std::min(margin, least_room_m) - slack_m);
      return stays_clear(path, hit, std::min(distance_m, room_m));
    }
    default:
      return stays_clear(path, hit, std::min(margin, least_room_m - slack_m));
  }
}

/// Beside the robot, what is a little ahead of its middle comes nearer by a hair as it drives on.
double ProtectiveField::drift_beside_m(const FieldHit& hit) const {
  return std::abs(hit.point_in_base.x()) <= options_.beside_m ? options_.beside_drift_m : 0.0;
}

/// A disc that turns on the spot comes no nearer to anything, but for the noise of its wheels.
bool ProtectiveField::stays_clear(const BrakingPath& path, const FieldHit& hit, double room_m) const {
  constexpr double rounding_m = 1e-9;
  const double drift_m = path.is_turn() && shape_.is_disc() ? options_.turn_drift_m : 0.0;
  return std::ranges::all_of(path.steps(), [&](const BrakingPath::Step& step) {
    return shape_.distance_m(inverse(step.end) * hit.point_in_base) >= room_m - drift_m - rounding_m;
  });
}

bool ProtectiveField::rests_in_time(const BrakingPath& path, const FieldHit& hit, double after_s) const {
  const double margin = margin_m(hit.presence);
  const double slow_mps = hit.presence == Presence::hidden ? options_.hidden_contact_mps : 0.0;
  return std::ranges::all_of(path.steps(), [&](const BrakingPath::Step& step) {
    if (step.speed_mps <= slow_mps) return true;
    const double distance_m = shape_.distance_m(inverse(step.middle) * hit.point_in_base);
    return distance_m - step.sway_m > reach_m(hit.presence, after_s + step.until_s) + margin;
  });
}

}  // namespace lodestar
