#include "app/placement/live_survey.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <thread>

#include "tests/app/bench/survey_tour.hpp"

namespace lodestar {
namespace {

using namespace survey_sample;

/// What the robot sees comes in pieces; each estimate is of all so far.
TEST(LiveSurvey, grows_with_the_drive_and_says_what_has_changed) {
  const SurveyTour tour = small_tour(20);
  Site site;
  site.cameras.emplace("wide", tour.world.camera);
  site.registry.markers = tour.world.markers;
  site.registry.markers[1].position_m.x() += 0.05;
  site.robot.base_from_camera = tour.world.belief.base_from_camera;
  site.robot.track_width_m = tour.world.belief.track_width_m;
  site.robot.mount_tilt_sigma_rad = tour.world.belief.lean_sigma_rad;
  std::vector<std::size_t> markers;
  std::shared_ptr<const SurveyProgress> last;
  {
    LiveSurvey live(site, "wide", {.period = std::chrono::milliseconds(20)});
    const auto next_estimate = [&] {
      const std::uint64_t before = last ? last->number : 0;
      for (int i = 0; i < 2000; ++i) {
        last = live.newest();
        if (last && last->number > before) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    };
    std::size_t wheel = 0;
    const std::vector<SurveyFrame>& frames = tour.drive.log.frames;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      for (; wheel < tour.drive.log.wheels.size() && tour.drive.log.wheels[wheel].stamp <= frames[i].stamp;
           ++wheel)
        live.add(tour.drive.log.wheels[wheel]);
      live.add(frames[i]);
      if (i != frames.size() / 10 && i + 1 != frames.size()) continue;
      next_estimate();
      ASSERT_TRUE(last);
      markers.push_back(last->survey.markers.size());
    }
    const auto with_markers = std::ranges::count_if(frames, [](const auto& f) { return !f.markers.empty(); });
    // An estimate may have begun before the last frame.
    if (static_cast<std::ptrdiff_t>(last->frames) < with_markers) next_estimate();
  }
  EXPECT_LT(markers.front(), tour.world.markers.size());
  EXPECT_EQ(last->survey.markers.size(), tour.world.markers.size());
  EXPECT_TRUE(last->survey.flaws.empty()) << words_of(last->survey);
  EXPECT_TRUE(last->is_on_map);
  ASSERT_TRUE(last->difference);
  ASSERT_EQ(last->difference->proposals.size(), 1U);
  EXPECT_EQ(last->difference->proposals.front().id, site.registry.markers[1].id);
  EXPECT_FALSE(last->links.empty());
}

}  // namespace
}  // namespace lodestar
