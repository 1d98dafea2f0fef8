#pragma once

#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

#include "drivers/system/clock.hpp"

#include "tests/can/process.hpp"
#include "tests/can/witness.hpp"

namespace lodestar {

/// The simulated base and the navigator as processes on a CAN interface of this kernel, and a witness. The
/// tests change network interfaces, so they refuse to run anywhere but in a User-Mode Linux.
class CanLab : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// A virtual interface for both, unless the test lays another cable.
  virtual void lay_cable();
  virtual void take_cable_away();

  void start_base(const std::string& options = "");
  void start_run(const std::string& goals);

  /// Once the base has come to rest: how long after `since` the navigator said that there is a fault, how
  /// long the base was still told to move, when it was first told to stand, and how far it went. Adds a line
  /// to measured.csv.
  void measure(const std::string& fault, Stamp since) const;

  /// `to` came so soon after `from`, or sooner. What User-Mode Linux itself takes is added.
  static void expect_within(Duration bound, Stamp from, Stamp to, const std::string& what);
  /// The navigator says so, so soon after `since`.
  void expect_said_within(Duration bound, const std::string& words, Stamp since) const;
  /// Nobody commands motion any more, from so soon after `since` on.
  void expect_no_motion_after(Duration bound, Stamp since) const;

  /// Drives, on a straight leg. The time at which that was seen.
  Stamp wait_until_driving();
  /// The exit code of the mission; nothing when it does not end in time, or is stopped by a fault after
  /// `since`.
  std::optional<int> wait_for_the_end(Duration longest, Stamp since = Stamp{}) const;
  /// The navigator has said so on its way.
  bool wait_for_words(const std::string& words, Duration longest) const;
  bool wait_for_any_words(const std::vector<std::string>& words, Duration longest) const;
  /// Somebody resumes after a fault, and again where the cause was still there. False when it never went.
  bool resume(Duration longest);
  /// The same, once: a further fault ends the wait.
  std::optional<int> resume_and_wait_for_the_end(Duration longest);

  /// How the simulated drive truly ended.
  struct Truth {
    double x_m = 0.0;
    double y_m = 0.0;
    double heading_deg = 0.0;
    double driven_m = 0.0;
    int contacts = -1;
  };
  Truth end_base();

  std::string site = LODESTAR_SOURCE_DIR "/sites/lab";
  std::string navigator_end = "vcan0";
  std::string base_end = "vcan0";
  std::unique_ptr<Witness> witness;
  std::unique_ptr<Process> base;
  std::unique_ptr<Process> run;
};

}  // namespace lodestar
