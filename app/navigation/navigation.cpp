#include "app/navigation/navigation.hpp"

#include <algorithm>
#include <utility>

#include "control/differential_drive.hpp"

namespace lodestar {
namespace {

void report(const LocalizationState& known, Stamp now, NavigationStep& step) {
  step.camera = known.camera.fault(now);
  step.rolled_unseen_m = known.integrity.rolled_since_agreement_m();
  step.distrusted = known.trust.distrusted();
  step.wheel_scales = known.filter.wheel_scales();
}

PoseFilterOptions filter_options(const NavigationOptions& options) {
  PoseFilterOptions filter = options.filter;
  if (!options.learned) return filter;
  filter.learned_scales = options.learned->wheel_scales;
  filter.registry_variance = options.learned->registry_variance;
  return filter;
}

VarianceFactor variance_factor(const NavigationOptions& options) {
  return options.learned ? options.learned->variance_factor : VarianceFactor();
}

RobotShape shape_of(const GridPlannerOptions& robot) {
  return robot.footprint ? RobotShape(*robot.footprint) : RobotShape(robot.radius_m);
}

}  // namespace

Navigation::Navigation(const KnownWorld& world, const NavigationOptions& options)
    : options_(options),
      zone_speed_(world.zones.speed_zones, shape_of(options.planner), options.drive),
      behaviour_options_{.drive = options.drive,
                         .spin = options.spin,
                         .backtrack = options.backtrack,
                         .steering = options.steering,
                         .left_path_m = options.route.left_path_m},
      localizer_(world.registry, world.camera, world.base_from_camera, options.detector, options.fix,
                 filter_options(options), variance_factor(options)),
      planner_(world.map, {.planner = options.planner, .route = options.route, .drive = options.drive},
               options.plan_arrival, world.zones.keep_out),
      known_{PoseFilter(filter_options(options)), MarkerTrust(options.trust), CameraWatch(options.camera),
             IntegrityMonitor(options.integrity)},
      behaviour_{Standing{}, Backtrack(options.backtrack)} {
  if (options.surroundings) surroundings_.emplace(*options.surroundings);
  if (!options.learned) return;
  for (const DistrustedMarker& marker : options.learned->distrusted) known_.trust.distrust(marker);
}

std::optional<LearnedState> Navigation::learned() const {
  if (!estimate_) return std::nullopt;
  return LearnedState{.wheel_scales = known_.filter.scales(),
                      .variance_factor = localizer_.variance_factor(),
                      .registry_variance = known_.filter.registry_variance(),
                      .distrusted = known_.trust.distrusted()};
}

/// Speed zones hold at once; keep-outs some steps later, as another map does.
void Navigation::use_zones(const Zones& zones) {
  zone_speed_ = ZoneSpeed(zones.speed_zones, shape_of(options_.planner), options_.drive);
  planner_.use_keep_out(zones.keep_out);
}

NavigationStep Navigation::step(const SensorInput& input) {
  if (input.zones) use_zones(*input.zones);

  // Localize. Travel comes first: a frame was exposed before the newest wheel reading, and the filter
  // corrects the past.
  NavigationStep step;
  for (const WheelTravel& travel : input.base.travel) known_.add_travel(travel);
  for (const Frame& frame : input.frames)
    if (std::optional<FixAttempt> used = localizer_.see(frame, input.now, known_))
      step.fixes.push_back(std::move(*used));
  step.estimate = known_.filter.estimate();
  if (step.estimate) step.zone_mps = speed_limit(*step.estimate);

  // Judge.
  const bool map_changed = planner_.begin_step(behaviour_.places.blind_places_m());
  Facts facts = judge(input, step, map_changed);
  look_around(input, facts);

  // Decide.
  const Behaviour about =
      planned(decided(behaviour_, facts, behaviour_options_), facts.estimate, step.reroute);

  // Command.
  Moved after = moved(about, facts, behaviour_options_);
  const Shown told = shown(about, after.behaviour, facts);
  step.stop = told.stop;
  step.backtracks = told.backtracks;
  protect(input, facts.elapsed, after, step);
  report(known_, input.now, step);

  behaviour_ = after.behaviour;
  if (!is_under_way(behaviour_.state)) wish_ = Wish::go_on;
  estimate_ = step.estimate;
  turned_rad_ = facts.turned_rad;
  last_step_ = input.now;
  return step;
}

Facts Navigation::judge(const SensorInput& input, const NavigationStep& step, bool map_changed) const {
  const auto reason_within = [&](const SafetyStopOptions& limits) {
    return with_integrity_alarms(reason_to_stop(input.now, step.estimate, limits), known_, input.now);
  };
  Facts facts{.now = input.now,
              .elapsed = last_step_ ? input.now - *last_step_ : Duration::zero(),
              .turned_rad = input.base.travel.empty()
                                ? turned_rad_
                                : turned_rad(input.base.travel.back(), options_.drive.track_width_m),
              .estimate = step.estimate,
              .sees_marker = std::ranges::find(step.fixes, FixOutcome::accepted, &FixAttempt::outcome) !=
                             step.fixes.end(),
              .stop = reason_within(options_.safety),
              .stop_on_backtrack = reason_within(options_.backtrack.limits),
              .wish = wish_,
              .steering = steering_ && input.now <= steering_->until ? std::optional(steering_->wanted)
                                                                     : std::nullopt,
              .may_look_around = may_look_around_,
              .map_changed = map_changed};
  judge_room(facts);
  facts.limit = lowered(facts.limit, step.zone_mps);
  facts.limit_on_backtrack = lowered(facts.limit_on_backtrack, step.zone_mps);
  return facts;
}

MappedPose Navigation::mapped_pose(const Facts& facts) const {
  return {planner_.map(), facts.stop ? std::nullopt : facts.estimate};
}

/// A scanner that cannot be believed is a reason to stop, behind those of the pose.
void Navigation::look_around(const SensorInput& input, Facts& facts) {
  if (!surroundings_) return;
  const PoseFilter& filter = known_.filter;
  surroundings_->use_scales({filter.wheel_scales().x(), filter.wheel_scales().y(), filter.turn_scale()});
  surroundings_->add_packets(input.packets, input.now);
  surroundings_->add(input.base.travel, input.scans, input.depths, input.now, mapped_pose(facts));
  plan_around_obstacles(facts);
  const std::optional<StopReason> reason = surroundings_->reason_to_stop(input.now);
  if (!facts.stop) facts.stop = reason;
  if (!facts.stop_on_backtrack) facts.stop_on_backtrack = reason;
}

/// Plans anew where something stands in the way that neither the map nor the last plan has.
void Navigation::plan_around_obstacles(const Facts& facts) {
  const Trip* const trip = trip_of(behaviour_.state);
  if (facts.stop || !facts.estimate || trip == nullptr) return;
  if (std::exchange(has_new_goal_, false)) {
    planner_.use_obstacles(surroundings_->unmapped(facts.now, mapped_pose(facts), goals_.ahead()));
    return;
  }
  const Path path = rest_of(trip->drive.path_ahead(), facts.estimate->map_from_base.position_m);
  if (auto obstacles =
          surroundings_->obstacles_in_the_way(facts.now, mapped_pose(facts), path, goals_.ahead()))
    planner_.use_obstacles(std::move(*obstacles));
}

/// The protective field has the last word on what is sent, whatever the behaviour.
void Navigation::protect(const SensorInput& input, Duration elapsed, Moved& after, NavigationStep& step) {
  step.command = after.command;
  if (!surroundings_) return;
  const Surroundings::Allowed allowed = surroundings_->allowed(input.now, input.base.measured, after.command);
  step.command = allowed.velocity;
  after.behaviour = after_sending(std::move(after.behaviour), allowed.velocity, elapsed);
  step.is_slowed = allowed.velocity.forward_mps != after.command.forward_mps ||
                   allowed.velocity.turn_radps != after.command.turn_radps;
  step.slowed_by = allowed.slowed_by;
  if (!step.stop) step.stop = allowed.reason;
}

std::optional<SeenSurroundings> Navigation::seen(Stamp now) const {
  return surroundings_ ? surroundings_->seen(now, {planner_.map(), estimate_}) : std::nullopt;
}

/// Sets the speed limits, with the safety margin for the pose uncertainty kept; zero where the clearance is
/// smaller than the margin.
void Navigation::judge_room(Facts& facts) const {
  CautionOptions caution = options_.caution;
  if (known_.integrity.is_contradicted()) caution.swing_per_m = caution.contradicted_swing_per_m;
  const auto limit_with = [&](const SafetyMargin& spare, const SafetyStopOptions& limits) {
    return safe_speed(planner_.forward_clearance(), *facts.estimate, spare,
                      {options_.drive, caution, limits});
  };
  const auto is_stuck = [&](const SpeedLimit& limit) {
    return limit.forward_mps < options_.drive.min_forward_mps;
  };
  if (!facts.stop) {
    const SafetyMargin spare = margin_for_uncertainty(facts.estimate->covariance);
    const double room_m = planner_.forward_clearance().room_m(facts.estimate->map_from_base);
    facts.limit = limit_with(spare, options_.safety);
    if (spare.here_m > 0.0 && room_m < spare.here_m) facts.limit.forward_mps = 0.0;
    if (is_stuck(facts.limit))
      facts.room_ahead =
          is_stuck(limit_with({}, options_.safety)) ? RoomAhead::none : RoomAhead::too_little_when_uncertain;
  }
  if (!facts.stop_on_backtrack)
    facts.limit_on_backtrack =
        limit_with(margin_on_the_way_back(facts.estimate->covariance), options_.backtrack.limits);
}

/// Asks for the plan that is wanted, and takes it when it arrives. One that is not wanted any more is
/// dropped.
Behaviour Navigation::planned(Behaviour behaviour, const std::optional<PoseEstimate>& estimate,
                              std::optional<RouteUpdate>& update) {
  for (;;) {
    const std::optional<PlanRequest> request = plan_wanted(behaviour.state);
    if (!request || !estimate) {
      planner_.drop();
      return behaviour;
    }
    if (!planner_.awaits(*request)) {
      const std::span<const Vec2> blind_m = behaviour.places.blind_places_m();
      planner_.ask({.request = *request,
                    .trip = *trip_of(behaviour.state),
                    .map_from_base = estimate->map_from_base,
                    .blind_m = {blind_m.begin(), blind_m.end()},
                    .goals = {goals_.ahead().begin(), goals_.ahead().end()}});
    }
    std::optional<TripPlan> plan = planner_.take();
    if (!plan) return behaviour;
    if (plan->update) update = std::move(plan->update);
    const bool is_found =
        std::holds_alternative<PathFound>(plan->answer) || std::holds_alternative<PathExtended>(plan->answer);
    if (is_found && request->kind != PlanKind::way_back) goals_.path_leads_to_all();
    behaviour = answered(std::move(behaviour), plan->answer);
  }
}

/// A plan that is on its way is of the goal before, even where the two are equal.
void Navigation::go_over(std::vector<Goal> goals) {
  wish_ = Wish::go_on;
  steering_.reset();
  planner_.drop();
  has_new_goal_ = surroundings_.has_value();
  const Goal& last = goals.back();
  behaviour_ = sent_to(std::move(behaviour_), last.position_m, last.passes ? std::nullopt : last.heading_rad,
                       behaviour_options_);
  goals_ = TripGoals(std::move(goals));
}

/// A plan that is on its way does not lead to them: it is asked for again.
void Navigation::extend(std::span<const Goal> goals) {
  planner_.drop();
  goals_.append(goals);
  behaviour_ = with_goals_beyond(std::move(behaviour_), goals_.beyond());
}

/// Of the zones here, and of the trip's legs while there is one. Follows the robot past the trip's goals.
std::optional<double> Navigation::speed_limit(const PoseEstimate& estimate) {
  std::optional<double> limit_mps = zone_speed_.limit_mps(estimate);
  if (!is_under_way(behaviour_.state)) return limit_mps;
  if (std::holds_alternative<Backtracking>(behaviour_.state)) {
    goals_.turn_back();
  } else {
    goals_.see(estimate.map_from_base.position_m);
  }
  const std::optional<double> leg_mps = goals_.limit_mps(estimate, options_.drive);
  if (!limit_mps || (leg_mps && *leg_mps < *limit_mps)) limit_mps = leg_mps;
  return limit_mps;
}

bool Navigation::place_robot(const Pose2& map_from_base, const PlacingSigma& sigma) {
  if (!last_step_) return false;
  PlanarFix said{.stamp = *last_step_, .map_from_base = map_from_base, .covariance = Eigen::Matrix3d::Zero()};
  said.covariance.diagonal() = Vec3(sigma.position_m, sigma.position_m, sigma.heading_rad).array().square();
  known_.integrity = IntegrityMonitor(options_.integrity);
  known_.trust.estimate_moved();
  if (surroundings_) surroundings_->pose_was_set();
  return known_.filter.start_at(said);
}

void Navigation::halt() {
  wish_ = Wish::halt;
  steering_.reset();
  may_look_around_ = false;
}

void Navigation::pause() {
  if (is_under_way(behaviour_.state) && wish_ == Wish::go_on) wish_ = Wish::pause;
}

void Navigation::resume() {
  if (wish_ == Wish::pause) wish_ = Wish::go_on;
}

void Navigation::cancel() {
  steering_.reset();
  if (wish_ != Wish::halt) wish_ = Wish::cancel;
}

}  // namespace lodestar
