#pragma once

#include "maps/stamp.hpp"

namespace lodestar {

/// What may come towards the robot, and how long the robot takes to be at rest. The rule is functional, never
/// certified: docs/decisions/0013-protective-field.md.
struct ProtectiveFieldOptions {
  /// Greatest speed of a person. 1.6 m/s is ISO 13855's; of recorded walkers 5 % are faster than 1.9 to 2.0.
  double person_mps = 2.0;
  /// A scanner at shin height sees legs that swing under a body: recorded walkers, 456 replays: 27 contacts
  /// with 5 cm, 1 with 25 cm.
  double swing_m = 0.25;
  /// Something that has stood for a second may be a person who begins to walk: reach a t^2 / 2. The centre of
  /// mass is moved by some 10 cm in the first half second of a step.
  double start_mps2 = 1.0;
  /// The same of what has legs: from rest to a walk within half a second, as by who is in a hurry. With 1
  /// m/s^2 a person who had stood half a metre beside a robot that turned on the spot walked into it before
  /// it was at rest.
  double legs_start_mps2 = 3.0;
  /// And of who came there, and may go at any time: with 3, discs that set off at once at 1.3 m/s touched a
  /// robot in the last two hundredths of a second before it was at rest.
  double waiting_start_mps2 = 4.0;
  double standing_margin_m = 0.02;  ///< a good standard deviation of the range (1.5 cm)
  /// However near it is, a robot does not come nearer than this to what stands: twice the noise of five
  /// beams.
  double least_standing_m = 0.01;
  /// Up to this speed what stands is passed like a wall: without it the noise of the range would end the
  /// drive in a gap that leaves 11 cm a side.
  double standing_creep_mps = 0.12;
  /// A body around standing legs: 0.25 m from its middle, 0.2 m from the shins of legs side by side. Nearer
  /// than that it may touch the robot, which then comes no nearer.
  double body_m = 0.20;
  double body_margin_m = 0.22;    ///< with the noise of five beams: a robot comes no nearer to legs by itself
  double mapped_margin_m = 0.01;  ///< the way's clearance is planned with elsewhere
  /// Beside what is at its margin or nearer, the room may shrink by this share of the way to rest: with the
  /// noise of the range the nearest hit along a wall is up to 5 cm ahead, and with that of the wheels a turn
  /// on the spot leads some tenths of a millimetre aside.
  double slack_share = 0.2;
  double turn_drift_m = 0.002;  ///< by which that noise leads a turn on the spot until it is at rest
  /// What is no farther ahead of the robot's middle, or behind it, is beside it. From 0.25 m to the side it
  /// comes nearer by 2 mm until it is abeam, and by the noise of the wheels.
  double beside_m = 0.03;
  double beside_drift_m = 0.003;
  /// Before who stays about a place and does not stand still, the robot stops so early that it may yet turn
  /// away on the spot, as fast as this, to drive around them. Chosen by hand among people who sway: with half
  /// of it some turns are held still.
  double turn_away_radps = 0.3;
  /// Someone may step out from behind what hides them, at the speed at which people walk off (chosen by hand,
  /// half of the greatest). Before they can touch it the robot is down to the contact speed, not to rest.
  double hidden_mps = 1.0;
  double hidden_contact_mps = 0.35;  ///< at most this in a contact that nobody could foresee

  /// From a command to its effect: the control step and the base's lag and latency (robot.yaml, response_s).
  /// The scan's turn and delivery are in the age of its beams.
  double control_step_s = 0.02;
  double response_s = 0.12;
  double deceleration_mps2 = 1.5;                          ///< protective, of its own: robot.yaml, measured
  double turn_deceleration_radps2 = 2.0;                   ///< likewise; the base's own limit
  Duration max_scan_age = std::chrono::milliseconds(300);  ///< three turns of a scanner at 10 Hz
};

}  // namespace lodestar
