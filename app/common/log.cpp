#include "app/common/log.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/common/background_writer.hpp"

namespace lodestar {
namespace {

constexpr std::array names{"debug", "info", "warning", "error"};

spdlog::level::level_enum level_of(Severity severity) {
  switch (severity) {
    case Severity::debug:
      return spdlog::level::debug;
    case Severity::info:
      return spdlog::level::info;
    case Severity::warning:
      return spdlog::level::warn;
    case Severity::error:
      return spdlog::level::err;
  }
  return spdlog::level::err;
}

/// As sd-daemon(3) has it: the level of syslog between angle brackets.
class JournalPrefix final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& line, const std::tm& /*time*/,
              spdlog::memory_buf_t& text) override {
    const char digit = line.level == spdlog::level::debug  ? '7'
                       : line.level == spdlog::level::info ? '6'
                       : line.level == spdlog::level::warn ? '4'
                                                           : '3';
    for (const char c : {'<', digit, '>'}) text.push_back(c);
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<JournalPrefix>();
  }
};

std::unique_ptr<spdlog::formatter> formatter_for(bool to_journal) {
  auto formatter = std::make_unique<spdlog::pattern_formatter>(spdlog::pattern_time_type::utc, "\n");
  formatter->add_flag<JournalPrefix>('*');
  formatter->set_pattern(to_journal ? "%*%v" : "%Y-%m-%dT%H:%M:%S.%eZ %l: %v");
  return formatter;
}

using Sink = spdlog::sinks::stdout_sink_base<spdlog::details::console_nullmutex>;

}  // namespace

struct Log::Writer {
  struct Line {
    spdlog::log_clock::time_point time;
    spdlog::level::level_enum level = spdlog::level::info;
    std::string words;
  };

  explicit Writer(const LogOptions& options)
      : logger("", std::make_shared<Sink>(options.out)),
        lines({.most_waiting = options.most_waiting}, [this](const Line& line) { write(line); }) {
    logger.set_formatter(formatter_for(options.to_journal));
    logger.set_level(level_of(options.least));
  }

  void write(const Line& line) { logger.log(line.time, {}, line.level, line.words); }

  spdlog::logger logger;
  BackgroundWriter<Line> lines;
};

std::optional<Severity> severity_named(std::string_view name) {
  const auto* const found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Severity>(found - names.begin());
}

Log::Log(const LogOptions& options) : writer_(std::make_unique<Writer>(options)) {}

Log::~Log() {
  const std::size_t dropped = writer_->lines.finish().dropped;
  if (dropped == 0) return;
  writer_->write({.time = spdlog::log_clock::now(),
                  .level = spdlog::level::warn,
                  .words = fmt::format("{} lines of this log are missing: written too slowly", dropped)});
}

void Log::say(Severity severity, std::string words) {
  if (!writer_->logger.should_log(level_of(severity))) return;
  std::ranges::replace_if(words, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  writer_->lines.put({spdlog::log_clock::now(), level_of(severity), std::move(words)});
}

void Log::set_least(Severity severity) {
  writer_->logger.set_level(level_of(severity));
}

bool goes_to_journal(int descriptor, const char* journal_stream) {
  if (journal_stream == nullptr) return false;
  struct stat stream{};
  if (::fstat(descriptor, &stream) != 0) return false;
  return fmt::format("{}:{}", stream.st_dev, stream.st_ino) == journal_stream;
}

Log& program_log() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody changes the environment
  static Log log({.to_journal = goes_to_journal(STDERR_FILENO, std::getenv("JOURNAL_STREAM"))});
  return log;
}

void log_debug(std::string words) {
  program_log().say(Severity::debug, std::move(words));
}

void log_info(std::string words) {
  program_log().say(Severity::info, std::move(words));
}

void log_warning(std::string words) {
  program_log().say(Severity::warning, std::move(words));
}

}  // namespace lodestar
