#include "localization/survey/heading_chain.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "maps/median.hpp"

namespace lodestar {
namespace {

constexpr std::size_t recent_frames = 3;  // a marker seen among so many keyframes has stayed in view

/// Keyframes that follow each other, by wheels or by a marker in view of both: [begin, end).
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};

bool shares_a_marker(const SurveyKeyframe& a, const SurveyKeyframe& b) {
  for (const KeyframeSighting& one : a.sightings)
    for (const KeyframeSighting& other : b.sightings)
      if (one.marker == other.marker) return true;
  return false;
}

std::vector<Stretch> stretches_of(const std::vector<SurveyKeyframe>& frames) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool follows = i > 0 && (frames[i].from_previous || (frames[i].log == frames[i - 1].log &&
                                                               shares_a_marker(frames[i - 1], frames[i])));
    if (!follows) stretches.push_back({i, i});
    stretches.back().end = i + 1;
  }
  return stretches;
}

class Chain {
 public:
  Chain(const SurveyKeyframes& keyframes, double track_width_m)
      : frames_(keyframes.frames), gauge_{.track_m = track_width_m}, first_yaw_(keyframes.ids.size()) {
    result_.heading_rad.resize(frames_.size(), 0.0);
    result_.yaw_less_heading.resize(frames_.size());
  }

  HeadingChain run() {
    std::vector<Stretch> left = stretches_of(frames_);
    for (const Stretch& stretch : left) chain(stretch);
    // The first stretch gives the direction; others are turned to it as markers in common allow.
    bool is_first = true;
    while (!left.empty()) {
      auto next = left.begin();
      std::optional<double> turn_rad;
      if (!is_first) {
        for (; next != left.end(); ++next)
          if ((turn_rad = turn_to_known(*next))) break;
        if (next == left.end()) next = left.begin();  // hangs together with none: not for us to say
      }
      is_first = false;
      place(*next, turn_rad.value_or(0.0));
      left.erase(next);
    }
    return std::move(result_);
  }

 private:
  void chain(const Stretch& stretch) {
    std::map<std::size_t, std::pair<double, std::size_t>> placed;  // yaw, and the keyframe last seen from
    for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
      const SurveyKeyframe& frame = frames_[i];
      double heading = i > stretch.begin ? result_.heading_rad[i - 1] : 0.0;
      if (i > stretch.begin && frame.from_previous) heading += frame.from_previous->motion(gauge_).turn_rad;
      const auto recent = [&](const KeyframeSighting& sighting) {
        const auto found = placed.find(sighting.marker);
        return found != placed.end() && i - found->second.second <= recent_frames ? &found->second : nullptr;
      };
      std::vector<double> corrections;
      for (const KeyframeSighting& sighting : frame.sightings)
        if (const auto* const known = recent(sighting))
          corrections.push_back(wrap_angle(known->first - sighting.base_from_marker.yaw_rad - heading));
      if (!corrections.empty()) heading += median(corrections);
      result_.heading_rad[i] = heading;
      for (const KeyframeSighting& sighting : frame.sightings) {
        if (auto* const known = recent(sighting))
          known->second = i;
        else
          placed[sighting.marker] = {heading + sighting.base_from_marker.yaw_rad, i};
      }
    }
  }

  /// Turn of the whole stretch that agrees with markers placed before; nothing when it shows none.
  [[nodiscard]] std::optional<double> turn_to_known(const Stretch& stretch) const {
    Vec2 sum = Vec2::Zero();
    for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
      for (const KeyframeSighting& sighting : frames_[i].sightings) {
        if (!first_yaw_[sighting.marker]) continue;
        const double turn =
            *first_yaw_[sighting.marker] - sighting.base_from_marker.yaw_rad - result_.heading_rad[i];
        sum += Vec2(std::cos(turn), std::sin(turn));
      }
    }
    return sum.norm() > 0.0 ? std::optional(heading_of(sum)) : std::nullopt;
  }

  void place(const Stretch& stretch, double turn_rad) {
    constexpr double whole = 2.0 * std::numbers::pi;
    for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
      double& heading = result_.heading_rad[i];
      heading += turn_rad;
      for (const KeyframeSighting& sighting : frames_[i].sightings) {
        const double seen = sighting.base_from_marker.yaw_rad;
        std::optional<double>& first = first_yaw_[sighting.marker];
        if (!first) first = heading + seen;
        result_.yaw_less_heading[i].push_back(seen + whole * std::round((*first - heading - seen) / whole));
      }
    }
  }

  const std::vector<SurveyKeyframe>& frames_;
  WheelGauge gauge_;
  std::vector<std::optional<double>> first_yaw_;
  HeadingChain result_;
};

}  // namespace

HeadingChain chain_headings(const SurveyKeyframes& keyframes, double track_width_m) {
  return Chain(keyframes, track_width_m).run();
}

}  // namespace lodestar
