#include <algorithm>
#include <cmath>

#include "app/fleet/fleet_session.hpp"
#include "app/recording/drive_moment.hpp"

// Of the fleet session: what the master is told, and when.
namespace lodestar {

/// A reason that lasts: one that comes and goes is not worth a message each time.
void FleetSession::note_stop(const NavigationStep& step) {
  constexpr Duration lasts = std::chrono::milliseconds(500);
  std::string why;
  if (base_.state == BaseState::fault) {
    why = "base: " + in_words(base_.state, base_.fault, base_.details);
  } else if (step.stop) {
    why = to_string(*step.stop);
  }
  if (why != stop_ || !stop_since_) {
    stop_ = std::move(why);
    stop_since_ = now_;
  }
  if (now_ - *stop_since_ >= lasts) book_.set_stopped(stop_);
}

bool FleetSession::wants_base(const NavigationStep& step) const {
  const bool has_horizon = !book_.nodes().empty() && !book_.nodes().back().released;
  if (!has_horizon || !step.estimate) return false;
  double left_m = 0.0;
  Vec2 from_m = step.estimate->map_from_base.position_m;
  for (const FleetNode& node : book_.nodes()) {
    if (!node.released) break;
    left_m += (node.at->position_m - from_m).norm();
    from_m = node.at->position_m;
  }
  return left_m < options_.ask_for_base_m;
}

void FleetSession::report(const NavigationStep& step, const Mission& mission) {
  const Visible visible{.revision = book_.revision(),
                        .connections = link_.connections(),
                        .driving = !wheels_.holds(),
                        .charging = charging_ && charging_->state() == ChargingState::charging,
                        .paused = book_.is_paused() || (is_ours_ && mission.paused()),
                        .wants_base = wants_base(step),
                        .field_violation = step.stop && waits_for_others(*step.stop),
                        .emergency_stop = base_.fault == BaseFault::emergency_stop ? EmergencyStop::manual
                                                                                   : EmergencyStop::none};
  if (node_of_driven_ != book_.last_sequence()) driven_m_ = 0.0;
  node_of_driven_ = book_.last_sequence();
  const Duration since = now_ - reported_at_;
  const bool is_due = !reported_ || since >= options_.most_interval ||
                      (since >= options_.least_interval && (is_state_asked_ || visible != *reported_));
  if (!is_due || !link_.publish(report_of(step, visible))) return;
  reported_ = visible;
  reported_at_ = now_;
  is_state_asked_ = false;
}

FleetReport FleetSession::report_of(const NavigationStep& step, const Visible& visible) const {
  constexpr double charged_percent = 80.0;  // VDA 5050: 20 for low and 80 for good where no more is known
  FleetReport report{.order_id = book_.order_id(),
                     .update_id = book_.update_id(),
                     .last_node_id = book_.last_node_id(),
                     .last_sequence = book_.last_sequence(),
                     .nodes = book_.nodes(),
                     .edges = book_.edges(),
                     .actions = book_.actions(),
                     .errors = book_.errors(),
                     .map_from_base = {},
                     .map = options_.book.map,
                     .velocity = base_.measured.value_or(BodyVelocity{}),
                     .driving = visible.driving,
                     .paused = visible.paused,
                     .wants_base = visible.wants_base,
                     .since_last_node_m = driven_m_,
                     .charge_percent = charged_percent,
                     .charging = visible.charging,
                     .battery_v = {},
                     .mode = book_.mode(),
                     .emergency_stop = visible.emergency_stop,
                     .field_violation = visible.field_violation};
  if (step.estimate) {
    report.map_from_base = step.estimate->map_from_base;
    report.deviation_m = std::sqrt(std::max(0.0, step.estimate->covariance.topLeftCorner<2, 2>().trace()));
  }
  if (base_.system && base_.system->battery_v > 0.0) {
    report.battery_v = base_.system->battery_v;
    if (options_.battery) report.charge_percent = options_.battery->percent_at(*report.battery_v);
  }
  return report;
}

}  // namespace lodestar
