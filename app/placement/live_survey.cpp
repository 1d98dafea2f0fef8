#include "app/placement/live_survey.hpp"

#include <algorithm>
#include <utility>

#include "app/common/low_priority.hpp"
#include "app/common/stopwatch.hpp"

namespace lodestar {

LiveSurvey::LiveSurvey(const Site& site, const std::string& camera, const LiveSurveyOptions& options)
    : options_(options),
      estimator_(site, camera, options.estimate),
      thread_([this](const std::stop_token& ends) { work(ends); }) {}

void LiveSurvey::add(SurveyFrame frame) {
  const std::scoped_lock lock(mutex_);
  new_frames_.push_back(std::move(frame));
}

void LiveSurvey::add(const WheelTravel& reading) {
  const std::scoped_lock lock(mutex_);
  new_wheels_.push_back(reading);
}

void LiveSurvey::add(const VisualOdometryIncrement& motion) {
  const std::scoped_lock lock(mutex_);
  new_ceiling_.push_back(motion);
}

std::shared_ptr<const SurveyProgress> LiveSurvey::newest() const {
  const std::scoped_lock lock(mutex_);
  return newest_;
}

void LiveSurvey::work(const std::stop_token& ends) {
  lower_priority_of_this_thread();
  Duration pause = options_.period;
  std::unique_lock lock(mutex_);
  while (!ends.stop_requested()) {
    wake_.wait_for(lock, ends, pause, [] { return false; });
    if (ends.stop_requested() || new_frames_.empty()) continue;
    std::vector<SurveyFrame> frames = std::exchange(new_frames_, {});
    const std::vector<WheelTravel> wheels = std::exchange(new_wheels_, {});
    const std::vector<VisualOdometryIncrement> ceiling = std::exchange(new_ceiling_, {});
    lock.unlock();
    for (SurveyFrame& frame : frames) estimator_.add(std::move(frame));
    for (const WheelTravel& reading : wheels) estimator_.add(reading);
    for (const VisualOdometryIncrement& motion : ceiling) estimator_.add(motion);
    const Stopwatch watch;
    auto progress = std::make_shared<SurveyProgress>(estimator_.estimate());
    if (options_.tell) options_.tell(*progress);
    pause = std::max<Duration>(options_.period, watch.elapsed());  // half of a core at most
    lock.lock();
    newest_ = std::move(progress);
  }
}

}  // namespace lodestar
