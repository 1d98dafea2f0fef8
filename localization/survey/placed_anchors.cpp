#include "localization/survey/placed_anchors.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace lodestar {
namespace {

constexpr double most_rolled_m = 0.5;  // wheels carry a pose so far and no farther

bool is_seen(const std::vector<int>& ids, int id) {
  return std::ranges::binary_search(ids, id);
}

/// The log of a robot's anchor; the first when it names none.
std::optional<std::size_t> log_of(const RobotAnchor& anchor, std::span<const SurveyLog> logs) {
  if (anchor.log.empty()) return logs.size() == 1 ? std::optional<std::size_t>(0) : std::nullopt;
  const auto found = std::ranges::find(logs, anchor.log, &SurveyLog::name);
  if (found == logs.end()) return std::nullopt;
  return static_cast<std::size_t>(found - logs.begin());
}

Stamp stamp_of(const RobotAnchor& anchor) {
  return Stamp(from_seconds(anchor.at_s));
}

/// From the keyframe to where the robot stood, by its wheels; nothing when they say nothing.
std::optional<Pose2> keyframe_from_robot(const SurveyLog& log, Stamp keyframe, Stamp robot,
                                         double track_width_m) {
  const auto rolled = WheelSegment::between(log.wheels, std::min(keyframe, robot), std::max(keyframe, robot));
  if (!rolled) return keyframe == robot ? std::optional(Pose2{}) : std::nullopt;
  const WheelMotion motion = rolled->motion({.track_m = track_width_m});
  const Pose2 way{motion.way_m, motion.turn_rad};
  return keyframe <= robot ? way : inverse(way);
}

/// The keyframe nearest in time from which wheels carry to the anchor.
std::optional<PlacedAnchor> place_robot(const RobotAnchor& robot, std::span<const SurveyLog> logs,
                                        const SurveyKeyframes& keyframes, double track_width_m) {
  const auto log = log_of(robot, logs);
  std::optional<PlacedAnchor> nearest;
  Duration least = Duration::max();
  for (std::size_t k = 0; log && k < keyframes.frames.size(); ++k) {
    const SurveyKeyframe& frame = keyframes.frames[k];
    const Duration off = std::chrono::abs(frame.stamp - stamp_of(robot));
    if (frame.log != *log || off >= least) continue;
    const auto way = keyframe_from_robot(logs[*log], frame.stamp, stamp_of(robot), track_width_m);
    if (!way || way->position_m.norm() > most_rolled_m) continue;
    least = off;
    nearest = PlacedAnchor{.keyframe = k, .keyframe_from_robot = *way};
  }
  return nearest;
}

}  // namespace

std::vector<KeptStamp> kept_stamps(const Anchors& anchors, std::span<const SurveyLog> logs) {
  std::vector<KeptStamp> kept;
  for (const Anchor& anchor : anchors.anchors) {
    const auto* const robot = std::get_if<RobotAnchor>(&anchor.what);
    if (robot == nullptr) continue;
    if (const auto log = log_of(*robot, logs)) kept.push_back({*log, stamp_of(*robot)});
  }
  return kept;
}

std::vector<PlacedAnchor> place_anchors(const Anchors& anchors, std::span<const SurveyLog> logs,
                                        const SurveyKeyframes& keyframes, double track_width_m,
                                        std::vector<SurveyRefusal>& flaws) {
  std::vector<PlacedAnchor> placed;
  const auto unseen = [&](const Anchor& anchor, int id) {
    flaws.push_back({SurveyFlaw::too_few_sightings,
                     fmt::format("marker {} of the anchors (line {}) is in no frame", id, anchor.line)});
  };
  for (std::size_t i = 0; i < anchors.anchors.size(); ++i) {
    const Anchor& anchor = anchors.anchors[i];
    if (const auto* const marker = std::get_if<MarkerAnchor>(&anchor.what)) {
      if (is_seen(keyframes.ids, marker->id))
        placed.push_back({.anchor = i});
      else
        unseen(anchor, marker->id);
    } else if (const auto* const apart = std::get_if<DistanceAnchor>(&anchor.what)) {
      if (!is_seen(keyframes.ids, apart->first)) unseen(anchor, apart->first);
      if (!is_seen(keyframes.ids, apart->second)) unseen(anchor, apart->second);
      if (is_seen(keyframes.ids, apart->first) && is_seen(keyframes.ids, apart->second))
        placed.push_back({.anchor = i});
    } else if (const auto* const robot = std::get_if<RobotAnchor>(&anchor.what)) {
      auto nearest = place_robot(*robot, logs, keyframes, track_width_m);
      if (nearest) {
        nearest->anchor = i;
        placed.push_back(*nearest);
      } else {
        flaws.push_back({SurveyFlaw::too_few_sightings,
                         fmt::format("{} (line {}): no marker in view within {} m of there",
                                     to_string(anchor), anchor.line, most_rolled_m)});
      }
    }
  }
  return placed;
}

}  // namespace lodestar
