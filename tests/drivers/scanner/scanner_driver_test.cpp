#include "drivers/scanner/scanner_driver.hpp"

#include <atomic>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>

#include "maps/input_error.hpp"

#include "tests/drivers/scanner/dialogue.hpp"
#include "tests/drivers/scanner/hosted.hpp"

namespace lodestar {
namespace {

void expect_room(const Scan& scan, double unit_m) {
  ASSERT_GE(scan.beams.size(), 300U);
  for (const Beam& beam : scan.beams) {
    ASSERT_EQ(beam.echo, Echo::hit);
    ASSERT_NEAR(beam.range_m, uneven_room_m(beam.angle_rad).value(), 0.51 * unit_m + 0.0035);
  }
}

/// Real time: the stand-in sends as a device does. Waits long for slow machines, and no longer than needed.
std::optional<Scan> wait_for_scan(Scanner& scanner) {
  for (int i = 0; i < 10000; ++i) {
    if (std::optional<Scan> scan = scanner.poll()) return scan;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return std::nullopt;
}

void expect_three_scans(const std::string& address, double unit_m) {
  const std::unique_ptr<Scanner> scanner = open_scanner(address);
  for (int i = 0; i < 3; ++i) {
    const std::optional<Scan> scan = wait_for_scan(*scanner);
    ASSERT_TRUE(scan) << address << ": " << scanner->description();
    expect_room(*scan, unit_m);
    const Duration age = monotonic_now() - scan->beams.back().stamp;
    EXPECT_GE(age, Duration::zero());
    EXPECT_LT(age, std::chrono::seconds(2));
  }
  EXPECT_GE(scanner->packets().read, 3U) << address;
}

std::string pty_name(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("lodestar-" + name + std::to_string(::getpid())))
      .string();
}

TEST(ScannerDriver, reads_an_ld19_and_an_rplidar_at_a_serial_line) {
  const std::string ld19 = pty_name("ld19");
  const Hosted hosted(std::make_unique<Ld19StandIn>(), serve_pty(ld19));
  expect_three_scans("ld19:" + ld19, 0.001);
  const std::string rplidar = pty_name("rplidar");
  const Hosted other(std::make_unique<RplidarStandIn>(), serve_pty(rplidar));
  expect_three_scans("rplidar:" + rplidar + "@256000", 0.001);
}

TEST(ScannerDriver, reads_a_hokuyo_over_tcp) {
  constexpr unsigned port = 47311;
  const Hosted hosted(std::make_unique<ScipStandIn>(), serve_tcp("127.0.0.1", port));
  expect_three_scans("scip:127.0.0.1:47311", 0.001);
}

TEST(ScannerDriver, reads_a_nanoscan_over_udp) {
  constexpr unsigned port = 47312;
  const Hosted hosted(std::make_unique<NanoscanStandIn>(), serve_udp("127.0.0.1", port));
  expect_three_scans("nanoscan:47312", 0.001);
}

TEST(ScannerDriver, finds_a_scanner_that_was_unplugged_and_comes_back) {
  const std::string device = pty_name("replug");
  auto hosted = std::make_unique<Hosted>(std::make_unique<RplidarStandIn>(), serve_pty(device));
  ScannerDriver scanner([&] { return open_serial(device, 115200, false); },
                        std::make_unique<RplidarProtocol>(), {.retry_period = std::chrono::milliseconds(20)});
  ASSERT_TRUE(wait_for_scan(scanner));
  hosted.reset();
  for (int i = 0; i < 50; ++i) {
    scanner.poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_FALSE(scanner.poll());
  hosted = std::make_unique<Hosted>(std::make_unique<RplidarStandIn>(), serve_pty(device));
  EXPECT_TRUE(wait_for_scan(scanner));
}

TEST(ScannerDriver, does_not_stop_a_stand_in_whose_reader_sleeps) {
  const std::string device = pty_name("sleeper");
  HostedScanner hosted(std::make_unique<Ld19StandIn>(), serve_pty(device), uneven_room_m);
  const ByteLink reader = open_serial(device, 230400);
  Stamp now{std::chrono::seconds(5)};
  for (int i = 0; i < 5000; ++i) hosted.step(now += std::chrono::milliseconds(2));  // 45 kB a second
  SUCCEED() << "a blocking write would have hung";
}

TEST(ScannerAddress, says_what_it_found_and_wanted) {
  for (const char* address :
       {"", "ld19", "ld19:", "ld19:ttyUSB0", "lidar:/dev/ttyUSB0", "rplidar:/dev/ttyUSB0@fast",
        "rplidar:/dev/ttyUSB0@0", "scip:host:99999", "scip::10940", "nanoscan:", "nanoscan:host"}) {
    try {
      open_scanner(address);
      ADD_FAILURE() << address;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("found '" + std::string(address) + "'"), std::string::npos) << text;
      EXPECT_NE(text.find("wanted ld19:DEVICE"), std::string::npos) << text;
    }
  }
  EXPECT_THROW(open_scanner("ld19:/dev/no-such-device"), InputError);
  EXPECT_THROW(open_scanner("ld19:/dev/null"), InputError);
  EXPECT_THROW(open_scanner("scip:127.0.0.1:1"), InputError);
}

}  // namespace
}  // namespace lodestar
