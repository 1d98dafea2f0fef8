#include "tests/can/lab.hpp"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

namespace lodestar {

using namespace std::chrono_literals;

namespace {

const std::string site = LODESTAR_SOURCE_DIR "/sites/lab";

bool is_in_user_mode_linux() {
  std::ostringstream text;
  text << std::ifstream("/proc/cpuinfo").rdbuf();
  return text.str().find("User Mode Linux") != std::string::npos;
}

std::vector<std::string> words_in(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

std::string log_named(const std::string& name) {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  return std::string(test->name()) + "." + name + ".txt";
}

}  // namespace

void CanLab::SetUp() {
  if (!is_in_user_mode_linux()) GTEST_SKIP() << "to be run by tests/can/in_uml";
  ASSERT_TRUE(shell("ip link add dev vcan0 type vcan && ip link set vcan0 txqueuelen 10 up"));
  witness = std::make_unique<Witness>(interface);
}

void CanLab::TearDown() {
  if (HasFailure() && run) std::printf("--- run:\n%s\n", run->output().c_str());
  if (HasFailure() && base) std::printf("--- base:\n%s\n", base->output().c_str());
  run.reset();
  base.reset();
  witness.reset();
  (void)shell("ip link del vcan0 2>/dev/null");
}

void CanLab::start_base(const std::string& options) {
  base = std::make_unique<Process>(
      words_in(std::string(LODESTAR_BINARY " base ") + site + " --can " + interface + " " + options),
      log_named("base"));
}

void CanLab::start_run(const std::string& goals) {
  run = std::make_unique<Process>(words_in(std::string(LODESTAR_BINARY " run ") + site + " " + goals),
                                  log_named("run"));
}

Stamp CanLab::wait_until_driving() {
  const auto driving = witness->wait_for(drives_faster_than(0.3), Stamp{}, 20s);
  EXPECT_TRUE(driving) << "never drove";
  return monotonic_now();
}

bool CanLab::wait_for_words(const std::string& words, Duration longest) const {
  const Stamp end = monotonic_now() + longest;
  while (run->output().find(words) == std::string::npos) {
    if (monotonic_now() >= end) return false;
    std::this_thread::sleep_for(10ms);
  }
  return true;
}

CanLab::Truth CanLab::end_base() {
  const std::string output = base->end();
  Truth truth;
  const std::size_t line = output.find("at ");
  if (line == std::string::npos) return truth;
  std::istringstream in(output.substr(line));
  std::string word;
  in >> word >> truth.x_m >> truth.y_m >> truth.heading_deg >> word >> truth.driven_m >> word >>
      truth.contacts;
  return truth;
}

}  // namespace lodestar
