#include <filesystem>
#include <gtest/gtest.h>
#include <mrpt/hwdrivers/CHokuyoURG.h>
#include <mrpt/hwdrivers/CRoboPeakLidar.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <unistd.h>

#include "drivers/scanner/rplidar_stand_in.hpp"
#include "drivers/scanner/scip_stand_in.hpp"
#include "maps/geometry.hpp"

#include "tests/drivers/scanner/hosted.hpp"

namespace lodestar {
namespace {

using mrpt::obs::CObservation2DRangeScan;

/// The next scan that MRPT reads, for as long as 200 of its attempts.
template <typename Driver>
bool read_scan(Driver& driver, CObservation2DRangeScan& scan) {
  for (int attempt = 0; attempt < 200; ++attempt) {
    bool is_there = false;
    bool has_failed = false;
    driver.doProcessSimple(is_there, scan, has_failed);
    if (is_there && !has_failed) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

TEST(Mrpt, reads_our_hokuyo_over_tcp_to_one_millimetre) {
  constexpr unsigned port = 47321;
  const Hosted hosted(std::make_unique<ScipStandIn>(), serve_tcp("127.0.0.1", port));
  const BeamPattern pattern = ScipStandIn().pattern();
  mrpt::hwdrivers::CHokuyoURG hokuyo;
  hokuyo.setIPandPort("127.0.0.1", port);
  ASSERT_TRUE(hokuyo.turnOn());
  for (int i = 0; i < 5; ++i) {
    CObservation2DRangeScan scan;
    ASSERT_TRUE(read_scan(hokuyo, scan));
    ASSERT_EQ(scan.getScanSize(), static_cast<std::size_t>(pattern.beams));
    EXPECT_TRUE(scan.rightToLeft);
    for (int beam = 0; beam < pattern.beams; ++beam) {
      const double angle_rad = pattern.first_rad + pattern.step_rad * beam;
      ASSERT_TRUE(scan.getScanRangeValidity(static_cast<std::size_t>(beam)));
      ASSERT_NEAR(scan.getScanRange(static_cast<std::size_t>(beam)), uneven_room_m(angle_rad).value(),
                  0.00051);
    }
  }
}

constexpr int served_degrees = 250;

double clockwise(double angle_rad) {
  const double clockwise_deg = -degrees(angle_rad);
  return clockwise_deg < 0.0 ? clockwise_deg + 360.0 : clockwise_deg;
}

/// Free space beyond 250 degrees, for MRPT 2.5.8 mistakes the angle's unit: it takes 90 / 16384 degrees for
/// 1 / 128, so that a reading stands at 1.42 times its angle, and beyond 253 degrees not in its scan at all.
std::optional<double> open_room_m(double angle_rad) {
  return clockwise(angle_rad) < served_degrees ? uneven_room_m(angle_rad) : std::nullopt;
}

/// Where it puts the beam that points half a degree past this one.
std::size_t mrpt_index(int degree) {
  const int q14 = ((degree * 64 + 32) << 8) / 90;
  return static_cast<std::size_t>((q14 >> 1) / 64);
}

void expect_rplidar_read(std::uint16_t typical_mode, double unit_m) {
  const std::string device =
      (std::filesystem::temp_directory_path() / ("lodestar-mrpt" + std::to_string(::getpid()))).string();
  const Hosted hosted(std::make_unique<RplidarStandIn>(typical_mode), serve_pty(device), open_room_m);
  mrpt::hwdrivers::CRoboPeakLidar rplidar;
  rplidar.setSerialPort(device);
  ASSERT_TRUE(rplidar.turnOn());
  int whole = 0;
  for (int i = 0; i < 20 && whole < 3; ++i) {
    CObservation2DRangeScan scan;
    ASSERT_TRUE(read_scan(rplidar, scan));
    if (scan.getScanSize() != 360) continue;  // it began within a turn
    ++whole;
    EXPECT_FALSE(scan.rightToLeft);
    std::size_t readings = 0;
    for (std::size_t place = 0; place < scan.getScanSize(); ++place)
      if (scan.getScanRangeValidity(place)) ++readings;
    EXPECT_EQ(readings, static_cast<std::size_t>(served_degrees));
    for (int degree = 0; degree < served_degrees; ++degree) {
      // An angle that is cut off a unit lower may stand one place before.
      const std::size_t index = mrpt_index(degree);
      const std::size_t at = scan.getScanRangeValidity(index) ? index : index - 1;
      ASSERT_TRUE(scan.getScanRangeValidity(at)) << degree;
      const double range_m = uneven_room_m(-radians(degree + 0.5)).value();
      ASSERT_NEAR(scan.getScanRange(at), range_m, 0.51 * unit_m) << degree;
    }
  }
  EXPECT_EQ(whole, 3);
}

TEST(Mrpt, reads_our_rplidars_standard_scan_to_a_quarter_of_a_millimetre) {
  expect_rplidar_read(0, 0.00025);
}

TEST(Mrpt, reads_our_rplidars_express_scan_to_one_millimetre) {
  expect_rplidar_read(1, 0.001);
}

TEST(Mrpt, reads_our_rplidars_dense_scan_to_one_millimetre) {
  expect_rplidar_read(2, 0.001);
}

}  // namespace
}  // namespace lodestar
