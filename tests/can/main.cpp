#include <algorithm>
#include <cstdio>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "drivers/system/clock.hpp"

#include "tests/can/pulse.hpp"

// Runs the tests; those that failed while the machine demonstrably stood still in between run again, and are
// not tested where it never comes to rest.
namespace lodestar {
namespace {

using namespace std::chrono_literals;

enum ExitCode : int { passed = 0, failed = 1, not_tested = 77 };

constexpr int most_attempts = 6;
constexpr Duration longest_total = 300s;  ///< no further attempt begins later
constexpr Duration long_pause = 30ms;     ///< more than a control period
constexpr double large_share = 0.05;      ///< of the test's time

/// On a busy machine such moments come now and then; they are not waited for without end.
void wait_for_a_quiet_moment() {
  constexpr Duration look_back = 1s;
  for (const Stamp end = monotonic_now() + 4s; monotonic_now() < end;) {
    const Stamp now = monotonic_now();
    if (pulse().lost(now - look_back, now) < look_back / 20) return;
    sleep_until(now + 100ms);
  }
}

class Disturbances final : public testing::EmptyTestEventListener {
 public:
  void OnTestStart(const testing::TestInfo& /*test*/) override {
    wait_for_a_quiet_moment();
    began_ = monotonic_now();
  }

  void OnTestEnd(const testing::TestInfo& test) override {
    const Stamp now = monotonic_now();
    const Duration pause = pulse().longest_pause(began_, now);
    const double share = seconds(pulse().lost(began_, now)) / seconds(now - began_);
    std::printf("             the machine stood still for %.0f ms at most, %.1f %% of the time\n",
                1e3 * seconds(pause), 100.0 * share);
    if (!test.result()->Failed()) return;
    const std::string name = std::string(test.test_suite_name()) + "." + test.name();
    (pause >= long_pause || share >= large_share ? disturbed_ : broken_).push_back(name);
  }

  [[nodiscard]] bool anything_broken() const { return !broken_.empty(); }
  /// Failed, but what that means nobody knows.
  std::vector<std::string> take_disturbed() { return std::exchange(disturbed_, {}); }

 private:
  Stamp began_;
  std::vector<std::string> disturbed_;
  std::vector<std::string> broken_;
};

std::string filter_for(const std::vector<std::string>& tests) {
  std::string filter;
  for (const std::string& test : tests) filter += (filter.empty() ? "" : ":") + test;
  return filter;
}

/// The process's exit code.
int run_until_they_prove_something(Disturbances& disturbances) {
  const Stamp end = monotonic_now() + longest_total;
  for (int attempt = 1; RUN_ALL_TESTS() != 0; ++attempt) {
    const std::vector<std::string> again = disturbances.take_disturbed();
    if (again.empty()) return failed;
    if (attempt == most_attempts || monotonic_now() > end) {
      std::printf("--- this machine is too busy to tell whether these hold: %s\n", filter_for(again).c_str());
      return disturbances.anything_broken() ? failed : not_tested;
    }
    std::printf("--- attempt %d: the machine stood still meanwhile, which proves nothing; again: %s\n",
                attempt, filter_for(again).c_str());
    GTEST_FLAG_SET(filter, filter_for(again));
    GTEST_FLAG_SET(repeat, 1);
  }
  return disturbances.anything_broken() ? failed : passed;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  auto* const disturbances = new lodestar::Disturbances;  // GoogleTest owns it
  testing::UnitTest::GetInstance()->listeners().Append(disturbances);
  (void)lodestar::pulse();
  return lodestar::run_until_they_prove_something(*disturbances);
}
