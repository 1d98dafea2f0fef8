#include "localization/survey/sighting_check.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace lodestar {
namespace {

constexpr double apart_m = 0.25;  // markers hang farther apart than that, and the start is better than that
constexpr double apart_rad = radians(20.0);
constexpr std::size_t most_of_start = 2;  // so few may be the start's errors: the least squares judge them

struct Stray {
  Vec2 position_m = Vec2::Zero();
  double off_m = 0.0;
};

std::vector<std::vector<Stray>> strays_by_marker(const SurveyKeyframes& keyframes, const SurveyStart& start) {
  std::vector<std::vector<Stray>> strays(keyframes.ids.size());
  for (std::size_t i = 0; i < keyframes.frames.size(); ++i) {
    for (const KeyframeSighting& sighting : keyframes.frames[i].sightings) {
      const Pose2 seen = start.map_from_base[i] * sighting.base_from_marker;
      const Pose2& marker = start.map_from_marker[sighting.marker];
      const double off_m = (seen.position_m - marker.position_m).norm();
      if (off_m > apart_m || std::abs(wrap_angle(seen.yaw_rad - marker.yaw_rad)) > apart_rad)
        strays[sighting.marker].push_back({seen.position_m, off_m});
    }
  }
  return strays;
}

SurveyRefusal refusal_of(const SurveyKeyframes& keyframes, const SurveyStart& start, std::size_t marker,
                         const Stray& stray) {
  const int id = keyframes.ids[marker];
  for (std::size_t other = 0; other < keyframes.ids.size(); ++other) {
    if (other == marker || (start.map_from_marker[other].position_m - stray.position_m).norm() > apart_m)
      continue;
    return {
        SurveyFlaw::same_id_twice,
        fmt::format("marker {} is also read where marker {} hangs, {:.1f} m from its other place: were they "
                    "swapped between logs?",
                    id, keyframes.ids[other], stray.off_m)};
  }
  return {SurveyFlaw::same_id_twice, fmt::format("marker {} at two places {:.1f} m apart", id, stray.off_m)};
}

}  // namespace

std::optional<SurveyRefusal> check_sightings(const SurveyKeyframes& keyframes, const SurveyStart& start) {
  const std::vector<std::vector<Stray>> strays = strays_by_marker(keyframes, start);
  std::optional<SurveyRefusal> refusal;
  double farthest_m = 0.0;
  for (std::size_t m = 0; m < strays.size(); ++m) {
    if (strays[m].size() <= most_of_start) continue;
    // Others stray too, pulled by the one that is at two places; it strays farthest.
    const Stray& worst = *std::ranges::max_element(strays[m], {}, &Stray::off_m);
    if (worst.off_m <= farthest_m) continue;
    farthest_m = worst.off_m;
    refusal = refusal_of(keyframes, start, m, worst);
  }
  return refusal;
}

}  // namespace lodestar
