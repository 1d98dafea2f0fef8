#include "drivers/system/device_clock.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "maps/random.hpp"

namespace lodestar {
namespace {

constexpr DeviceClockOptions ms_wrapping{.ticks_to_wrap = 30000};

/// A device that measures every 3 ms, of which each arrives 1 ms later or more.
struct Device {
  double drift = 0.0;
  double origin_s = 12.3;
  Random random{1};

  std::uint64_t ticks(double t_s) const {
    return static_cast<std::uint64_t>((origin_s + t_s * (1.0 - drift)) * 1000.0);
  }
};

Stamp at(double t_s) {
  return Stamp(from_seconds(1000.0 + t_s));
}

/// The worst error of stamps between these times. Arrivals are up to `jitter_s` late.
double worst_error_s(DeviceClock& clock, Device& device, double from_s, double to_s, double jitter_s,
                     double settled_s) {
  double worst = 0.0;
  double arrival_s = 0.0;
  for (double t_s = from_s; t_s < to_s; t_s += 0.003) {
    arrival_s = std::max(arrival_s, t_s + 0.001 + jitter_s * std::pow(device.random.uniform(), 2.0));
    const Stamp stamp = clock.stamp_of(device.ticks(t_s), at(arrival_s));
    EXPECT_LE(stamp, at(arrival_s));
    if (t_s >= settled_s) worst = std::max(worst, std::abs(seconds(stamp - at(t_s)) - 0.001));
  }
  return worst;
}

TEST(DeviceClock, removes_the_jitter_of_arrivals_through_wraps) {
  DeviceClock clock(ms_wrapping);
  Device device;
  EXPECT_LT(worst_error_s(clock, device, 0.0, 100.0, 0.030, 2.0), 0.0025);
  EXPECT_EQ(clock.restarts(), 0);
}

TEST(DeviceClock, learns_the_drift_of_a_poor_resonator) {
  for (const double drift : {-0.005, 0.005}) {
    DeviceClock clock(ms_wrapping);
    Device device{.drift = drift};
    EXPECT_LT(worst_error_s(clock, device, 0.0, 200.0, 0.010, 60.0), 0.004) << drift;
    EXPECT_NEAR(clock.drift(), drift, 0.0005);
  }
}

TEST(DeviceClock, keeps_the_time_of_measurement_when_deliveries_are_late) {
  DeviceClock clock(ms_wrapping);
  Device device;
  worst_error_s(clock, device, 0.0, 20.0, 0.002, 2.0);
  // The program was paused for 0.4 s, and reads all at once.
  for (double t_s = 20.0; t_s < 20.4; t_s += 0.003)
    EXPECT_NEAR(seconds(clock.stamp_of(device.ticks(t_s), at(20.4)) - at(t_s)), 0.001, 0.0025);
}

TEST(DeviceClock, starts_anew_with_a_restarted_device) {
  DeviceClock clock(ms_wrapping);
  Device device;
  worst_error_s(clock, device, 0.0, 10.0, 0.002, 2.0);
  device.origin_s = -11.0;  // counts from 0 again, a second later
  EXPECT_LT(worst_error_s(clock, device, 11.0, 20.0, 0.002, 11.5), 0.0035);
  EXPECT_EQ(clock.restarts(), 1);
}

TEST(DeviceClock, believes_arrivals_again_when_a_count_stays_behind) {
  DeviceClock clock(ms_wrapping);
  Device device;
  worst_error_s(clock, device, 0.0, 10.0, 0.002, 2.0);
  device.origin_s -= 8.0;  // off for ten seconds; its count seems to have gone on for two
  EXPECT_LT(worst_error_s(clock, device, 20.0, 40.0, 0.002, 23.0), 0.0035);
}

}  // namespace
}  // namespace lodestar
