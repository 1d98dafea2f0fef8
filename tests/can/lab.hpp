#pragma once

#include <gtest/gtest.h>
#include <memory>
#include <string>

#include "drivers/clock.hpp"

#include "tests/can/process.hpp"
#include "tests/can/witness.hpp"

namespace lodestar {

/// The simulated base and the navigator as processes on a CAN interface of this kernel, and a witness. The
/// tests change network interfaces, so they refuse to run anywhere but in a User-Mode Linux.
class CanLab : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  void start_base(const std::string& options = "");
  void start_run(const std::string& goals);

  /// Drives, on a straight leg. The time at which that was seen.
  Stamp wait_until_driving();
  /// The navigator has said so on its way.
  bool wait_for_words(const std::string& words, Duration longest) const;
  /// How the simulated drive truly ended.
  struct Truth {
    double x_m = 0.0;
    double y_m = 0.0;
    double heading_deg = 0.0;
    double driven_m = 0.0;
    int contacts = -1;
  };
  Truth end_base();

  static constexpr const char* interface = "vcan0";
  std::unique_ptr<Witness> witness;
  std::unique_ptr<Process> base;
  std::unique_ptr<Process> run;
};

}  // namespace lodestar
