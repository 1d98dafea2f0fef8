#include "drivers/simulation/simulated_camera.hpp"

#include <utility>

#include "maps/input_error.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

enum CameraPurpose : std::uint64_t { tilt_of_body = 1, loss_of_frames = 2 };

void check(const SimulatedCameraOptions& options) {
  if (options.exposure < Duration::zero() || options.exposure >= options.period) {
    throw InputError("simulated camera: the exposure must be shorter than the period");
  }
  if (options.latency < options.exposure / 2) {
    throw InputError("simulated camera: a frame cannot arrive before its exposure has ended");
  }
  if (!(options.lost_frame_probability >= 0.0 && options.lost_frame_probability <= 1.0)) {
    throw InputError("simulated camera: the share of lost frames must be in 0..1");
  }
}

const SimulatedCameraOptions& checked(const SimulatedCameraOptions& options) {
  check(options);
  return options;
}

Pose2 between(const Pose2& from, const Pose2& to, double fraction) {
  return {from.position_m + fraction * (to.position_m - from.position_m),
          wrap_angle(from.yaw_rad + fraction * wrap_angle(to.yaw_rad - from.yaw_rad))};
}

}  // namespace

SimulatedCamera::SimulatedCamera(const MarkerRegistry& registry, const CameraModel& camera,
                                 const Eigen::Isometry3d& base_from_camera,
                                 const SimulatedCameraOptions& options, std::uint64_t seed)
    : base_from_camera_(base_from_camera),
      options_(checked(options)),
      seed_(seed),
      wobble_(options.tilt_sigma_rad, Random(seed).stream(tilt_of_body)),
      image_former_(registry, camera, options, seed) {}

void SimulatedCamera::observe(Stamp now, const Pose2& true_map_from_base) {
  const Observation current{now, true_map_from_base};
  if (!last_) {
    last_ = current;
    while (opening_of(next_number_) < now) ++next_number_;
  }
  while (true) {
    const Stamp event = open_ ? open_->opening + options_.exposure : opening_of(next_number_);
    if (event > now) break;
    const Eigen::Isometry3d map_from_camera = map_from_camera_at(event, *last_, current);
    if (!open_) {
      open_ = Exposure{next_number_++, event, map_from_camera, map_from_camera, {}};
    } else {
      open_->map_from_camera_at_closing = map_from_camera;
      if (!is_lost(open_->number)) on_their_way_.push_back(*open_);
      open_.reset();
    }
  }
  last_ = current;
}

void SimulatedCamera::rehang(const MarkerRegistry& registry, std::vector<CeilingDisc> more_lamps) {
  for (Exposure& exposure : on_their_way_) form(exposure);
  image_former_.rehang(hang_markers(registry, options_, seed_), std::move(more_lamps));
}

std::optional<Frame> SimulatedCamera::poll() {
  if (on_their_way_.empty() || arrival_of(on_their_way_.front()) > last_->stamp) return std::nullopt;
  Exposure exposure = on_their_way_.front();
  on_their_way_.pop_front();
  form(exposure);
  return Frame{exposure.opening + options_.exposure / 2, exposure.gray};
}

void SimulatedCamera::form(Exposure& exposure) {
  if (!exposure.gray.empty()) return;
  exposure.gray = image_former_.expose(exposure.map_from_camera_at_opening,
                                       exposure.map_from_camera_at_closing, exposure.number);
}

void SimulatedCamera::keep_newest(std::size_t frames) {
  while (on_their_way_.size() > frames) on_their_way_.pop_front();
}

Stamp SimulatedCamera::opening_of(std::uint64_t number) const {
  return Stamp(options_.period * static_cast<Duration::rep>(number));
}

Stamp SimulatedCamera::arrival_of(const Exposure& exposure) const {
  return exposure.opening + options_.exposure / 2 + options_.latency;
}

bool SimulatedCamera::is_lost(std::uint64_t number) const {
  return Random(seed_).stream(loss_of_frames).stream(number).uniform() < options_.lost_frame_probability;
}

Eigen::Isometry3d SimulatedCamera::map_from_camera_at(Stamp stamp, const Observation& before,
                                                      const Observation& after) const {
  const double span_s = seconds(after.stamp - before.stamp);
  const double fraction = span_s > 0.0 ? seconds(stamp - before.stamp) / span_s : 1.0;
  const Pose2 map_from_base = between(before.map_from_base, after.map_from_base, fraction);
  return lifted(map_from_base) * wobble_.at(stamp) * base_from_camera_;
}

}  // namespace lodestar
