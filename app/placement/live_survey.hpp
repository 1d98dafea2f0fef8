#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

#include "app/placement/survey_estimator.hpp"

namespace lodestar {

struct LiveSurveyOptions {
  SurveyEstimatorOptions estimate;
  Duration period =
      std::chrono::seconds(2);  ///< from one estimate to the next; longer where one takes longer
  std::function<void(const SurveyProgress&)> tell;  ///< hears of each estimate, on its thread
};

/// Estimates the registry again and again from what the robot sees and how its wheels roll, on a thread of
/// its own with low priority. What it shows is never written: `lodestar survey` makes the registry.
class LiveSurvey {
 public:
  LiveSurvey(const Site& site, const std::string& camera, const LiveSurveyOptions& options = {});
  LiveSurvey(const LiveSurvey&) = delete;
  LiveSurvey& operator=(const LiveSurvey&) = delete;

  // From any thread; no call waits for an estimate.
  void add(SurveyFrame frame);
  void add(const WheelTravel& reading);
  void add(const VisualOdometryIncrement& motion);
  /// Null before the first estimate.
  [[nodiscard]] std::shared_ptr<const SurveyProgress> newest() const;

 private:
  void work(const std::stop_token& ends);

  LiveSurveyOptions options_;
  SurveyEstimator estimator_;  ///< the thread's
  mutable std::mutex mutex_;   ///< of the next four
  std::vector<SurveyFrame> new_frames_;
  std::vector<WheelTravel> new_wheels_;
  std::vector<VisualOdometryIncrement> new_ceiling_;
  std::shared_ptr<const SurveyProgress> newest_;
  std::condition_variable_any wake_;
  std::jthread thread_;  ///< last: it uses the others
};

}  // namespace lodestar
