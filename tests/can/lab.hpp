#pragma once

#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

#include "drivers/system/clock.hpp"

#include "tests/can/process.hpp"
#include "tests/can/witness.hpp"

namespace lodestar {

/// The simulated base and the navigator as processes on a CAN interface of this kernel, and a witness of the
/// bus. The tests change network interfaces, so they are skipped outside User-Mode Linux.
class CanLab : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// One virtual interface for both, unless the test sets up another connection.
  virtual void lay_cable();
  virtual void take_cable_away();

  void start_base(const std::string& options = "");
  void start_run(const std::string& goals);

  /// Once the base has come to rest, adds a line to measured.csv: how long after `since` the navigator
  /// reported the fault, sent the last moving command and the first zero command, and how far the base went.
  void measure(const std::string& fault, Stamp since) const;

  /// Expects `to` at most `bound` after `from`, plus 25 ms that User-Mode Linux itself takes.
  static void expect_within(Duration bound, Stamp from, Stamp to, const std::string& what);
  /// Expects that the navigator prints these words within `bound` after `since`.
  void expect_said_within(Duration bound, const std::string& words, Stamp since) const;
  /// Expects no moving command from `bound` after `since` on.
  void expect_no_motion_after(Duration bound, Stamp since) const;

  /// Waits until the base drives on a straight leg; returns that time.
  Stamp wait_until_driving();
  /// Exit code of the mission; nothing when it does not end in time or a fault stops it after `since`.
  std::optional<int> wait_for_the_end(Duration longest, Stamp since = Stamp{}) const;
  /// Waits until the navigator has printed these words.
  bool wait_for_words(const std::string& words, Duration longest) const;
  bool wait_for_any_words(const std::vector<std::string>& words, Duration longest) const;
  /// Requests a resume, repeatedly while the cause of the fault persists. False when none succeeds in time.
  bool resume(Duration longest);
  /// Resumes, then waits for the end of the mission; a further fault ends the wait.
  std::optional<int> resume_and_wait_for_the_end(Duration longest);

  /// Ground truth at the end of the simulated drive.
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
