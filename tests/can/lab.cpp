#include "tests/can/lab.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace lodestar {

using namespace std::chrono_literals;

namespace {

bool is_in_user_mode_linux() {
  std::ostringstream text;
  text << std::ifstream("/proc/cpuinfo").rdbuf();
  return text.str().find("User Mode Linux") != std::string::npos;
}

std::vector<std::string> words_in(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), {}};
}

bool a_guard_is_there() {
  return std::ranges::any_of(std::filesystem::directory_iterator("/proc"), [](const auto& process) {
    std::string name;
    return std::getline(std::ifstream(process.path() / "comm"), name) && name == "lodestar-guard";
  });
}

/// A guard sends stop commands for a while after its navigator has ended, also on the next test's interface.
void wait_until_guards_have_ended() {
  const Stamp end = monotonic_now() + 5s;
  while (a_guard_is_there() && monotonic_now() < end) std::this_thread::sleep_for(5ms);
}

constexpr Duration kernel_slack = 25ms;  ///< of User-Mode Linux: 2.5 of its ticks

}  // namespace

void CanLab::SetUp() {
  if (!is_in_user_mode_linux()) GTEST_SKIP() << "to be run by tests/can/in_uml";
  lay_cable();
  witness = std::make_unique<Witness>(base_end);
}

void CanLab::lay_cable() {
  ASSERT_TRUE(shell("ip link add dev vcan0 type vcan && ip link set vcan0 txqueuelen 10 up"));
}

void CanLab::take_cable_away() {
  (void)shell("ip link del vcan0 2>/dev/null");
}

void CanLab::TearDown() {
  std::error_code ignored;
  std::filesystem::remove(std::filesystem::path(site) / "state.yaml", ignored);  // each test learns anew
  if (HasFailure() && run) std::printf("--- run:\n%s\n", run->output().c_str());
  if (HasFailure() && base) std::printf("--- base:\n%s\n", base->output().c_str());
  run.reset();
  wait_until_guards_have_ended();
  base.reset();
  witness.reset();
  if (is_in_user_mode_linux()) take_cable_away();
}

void CanLab::start_base(const std::string& options) {
  base = std::make_unique<Process>(words_in(std::string(LODESTAR_BINARY " base ") + site + " --can " +
                                            base_end + " --world " + navigator_end + " " + options));
}

void CanLab::start_run(const std::string& goals) {
  run = std::make_unique<Process>(
      words_in(std::string(LODESTAR_BINARY " run ") + site + " --can " + navigator_end + " " + goals));
}

void CanLab::measure(const std::string& fault, Stamp since) const {
  const auto rest = witness->wait_for(says_standing, since + 200ms, 5s);
  const auto moving = witness->heard(is_moving_command, since, rest ? rest->stamp : Stamp::max());
  const auto zero = witness->heard(is_zero_command, since);
  const auto is_odometer = [](const CanFrame& frame) { return frame.id == agilex::odometer_id; };
  const auto before = witness->heard(is_odometer, Stamp{}, since);
  const auto after = witness->heard(is_odometer, since, rest ? rest->stamp + 20ms : Stamp::max());
  const auto travel_mm = [](const StampedCanFrame& frame) {
    const auto odometer = agilex::decode_odometer(frame.frame);
    return (odometer->left_mm + odometer->right_mm) / 2.0;
  };
  if (HasFailure()) return;
  const auto noticed = run->said("base: stopped by a fault", since);
  const auto ms_until = [since](Stamp event) { return 1e3 * seconds(event - since); };
  std::ofstream csv("measured.csv", std::ios::app);
  csv << fault << ',';
  if (noticed) csv << ms_until(*noticed);
  csv << ',' << (moving.empty() ? 0.0 : ms_until(moving.back().stamp)) << ',';
  if (!zero.empty()) csv << ms_until(zero.front().stamp);
  csv << ',';
  if (rest && !before.empty() && !after.empty()) csv << travel_mm(after.back()) - travel_mm(before.back());
  csv << '\n';
}

Stamp CanLab::wait_until_driving() {
  for (const Stamp end = monotonic_now() + 40s; monotonic_now() < end;) {
    if (witness->wait_for(drives_faster_than(0.3), monotonic_now(), 300ms)) return monotonic_now();
  }
  ADD_FAILURE() << "the base never drove";
  return monotonic_now();
}

bool CanLab::wait_for_words(const std::string& words, Duration longest) const {
  return wait_for_any_words({words}, longest);
}

bool CanLab::wait_for_any_words(const std::vector<std::string>& words, Duration longest) const {
  const Stamp end = monotonic_now() + longest;
  while (std::ranges::none_of(words, [&](const std::string& some) { return run->said(some).has_value(); })) {
    if (monotonic_now() >= end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

void CanLab::expect_within(Duration bound, Stamp from, Stamp to, const std::string& what) {
  EXPECT_LE(to - from, bound + kernel_slack) << what << " after " << 1e3 * seconds(to - from) << " ms";
}

void CanLab::expect_said_within(Duration bound, const std::string& words, Stamp since) const {
  constexpr Duration patience = 5s;
  std::optional<Stamp> said;
  for (const Stamp end = monotonic_now() + patience; !said && monotonic_now() < end;) {
    said = run->said(words, since);
    std::this_thread::sleep_for(5ms);
  }
  ASSERT_TRUE(said) << "never printed: " << words;
  expect_within(bound, since, *said, words);
}

void CanLab::expect_no_motion_after(Duration bound, Stamp since) const {
  constexpr Duration quiet = 500ms;
  sleep_until(since + bound + kernel_slack + 2 * quiet);
  const auto moving = witness->heard(is_moving_command, since);
  if (moving.empty()) return;
  expect_within(bound, since, moving.back().stamp, "the last moving command");
  EXPECT_GT(monotonic_now() - moving.back().stamp, quiet) << "motion is still commanded";
}

std::optional<int> CanLab::wait_for_the_end(Duration longest, Stamp since) const {
  std::optional<int> ended;
  const Stamp end = monotonic_now() + longest;
  while (!ended && monotonic_now() < end && !run->said("base: stopped by a fault", since)) {
    ended = run->wait(100ms);
  }
  return ended;
}

bool CanLab::resume(Duration longest) {
  for (const Stamp end = monotonic_now() + longest; monotonic_now() < end;) {
    const Stamp asked = monotonic_now();
    run->say("resume");
    while (monotonic_now() < end && !run->said("base: cannot resume", asked)) {
      if (run->said("base: ready", asked)) return true;
      std::this_thread::sleep_for(5ms);
    }
    std::this_thread::sleep_for(200ms);
  }
  return false;
}

std::optional<int> CanLab::resume_and_wait_for_the_end(Duration longest) {
  // Time for all of the base's messages to be received again.
  constexpr Duration patience = 5s;
  const Stamp asked = monotonic_now();
  if (!resume(patience)) {
    ADD_FAILURE() << "cannot resume";
    return std::nullopt;
  }
  return wait_for_the_end(longest, asked);
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
