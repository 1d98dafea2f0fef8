#include "app/common/log.hpp"

#include <algorithm>
#include <array>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <optional>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::EndsWith;
using ::testing::MatchesRegex;

/// A log to a file, and the file's content after the log has ended.
class LogFile {
 public:
  explicit LogFile(LogOptions options = {}) : file_(std::fopen((folder_ / "log").c_str(), "w")) {
    options.out = file_;
    log_.emplace(options);
  }
  ~LogFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  Log& operator*() { return *log_; }
  std::string ended() {
    log_.reset();
    std::ifstream in(folder_ / "log");
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  TemporaryFolder folder_;
  std::FILE* file_;
  std::optional<Log> log_;
};

TEST(Log, says_when_and_how_severe) {
  LogFile file;
  (*file).say(Severity::info, "base: ready");
  (*file).say(Severity::warning, "base: stopped by a fault");
  (*file).say(Severity::error, "no room");
  const std::string time = "[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}[.][0-9]{3}Z ";
  EXPECT_THAT(file.ended(), MatchesRegex(time + "info: base: ready\n" + time +
                                         "warning: base: stopped by a fault\n" + time + "error: no room\n"));
}

TEST(Log, has_levels_of_syslog_and_no_time_in_the_journal) {
  LogFile file({.least = Severity::debug, .to_journal = true});
  (*file).say(Severity::debug, "a");
  (*file).say(Severity::info, "b");
  (*file).say(Severity::warning, "c");
  (*file).say(Severity::error, "d");
  EXPECT_EQ(file.ended(), "<7>a\n<6>b\n<4>c\n<3>d\n");
}

TEST(Log, leaves_out_what_is_less_severe_than_asked_for) {
  LogFile file({.to_journal = true});
  (*file).say(Severity::debug, "a");
  (*file).say(Severity::info, "b");
  (*file).set_least(Severity::error);
  (*file).say(Severity::warning, "c");
  (*file).say(Severity::error, "d");
  (*file).set_least(Severity::debug);
  (*file).say(Severity::debug, "e");
  EXPECT_EQ(file.ended(), "<6>b\n<3>d\n<7>e\n");
}

TEST(Log, keeps_to_one_line_whatever_somebody_calls_himself) {
  LogFile file({.to_journal = true});
  (*file).say(Severity::info, "eve\n<3>{} all is \x1b[31mlost: go to (2.20, 5.00, 90°)");
  EXPECT_EQ(file.ended(), "<6>eve <3>{} all is  [31mlost: go to (2.20, 5.00, 90°)\n");
}

/// A terminal on hold, as after Ctrl-S.
TEST(Log, holds_nobody_up_when_nobody_reads_and_says_how_much_is_missing) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  std::FILE* const out = ::fdopen(ends[1], "w");
  constexpr int lines = 10'000;
  std::optional<Log> log;
  log.emplace(LogOptions{.to_journal = true, .out = out, .most_waiting = 10});
  for (int i = 0; i < lines; ++i) log->say(Severity::info, std::string(999, 'x'));  // returns, pipe full

  std::string read;
  std::thread terminal([&] {
    std::array<char, 4096> part{};
    for (ssize_t size = 0; (size = ::read(ends[0], part.data(), part.size())) > 0;)
      read.append(part.data(), static_cast<std::size_t>(size));
  });
  log.reset();
  std::fclose(out);
  terminal.join();
  ::close(ends[0]);
  const auto written = std::ranges::count(read, '\n') - 1;
  EXPECT_LT(written, lines);
  EXPECT_THAT(read, EndsWith(fmt::format("\n<4>{} lines of this log are missing: written too slowly\n",
                                         lines - written)));
}

TEST(Log, knows_the_journal_by_its_stream) {
  const TemporaryFolder folder;
  const int file = ::open((folder / "stream").c_str(), O_CREAT | O_WRONLY, 0600);
  struct stat stream{};
  ASSERT_EQ(::fstat(file, &stream), 0);
  const std::string own = fmt::format("{}:{}", stream.st_dev, stream.st_ino);
  EXPECT_TRUE(goes_to_journal(file, own.c_str()));
  EXPECT_FALSE(goes_to_journal(file, (own + "1").c_str())) << "redirected since";
  EXPECT_FALSE(goes_to_journal(file, nullptr));
  ::close(file);
  EXPECT_FALSE(goes_to_journal(file, own.c_str()));
}

TEST(Log, severities_have_names) {
  EXPECT_EQ(severity_named("debug"), Severity::debug);
  EXPECT_EQ(severity_named("error"), Severity::error);
  EXPECT_EQ(severity_named("loud"), std::nullopt);
}

}  // namespace
}  // namespace lodestar
