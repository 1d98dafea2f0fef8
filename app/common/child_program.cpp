#include "app/common/child_program.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

#include "app/common/spawn_attributes.hpp"
#include "app/common/stopwatch.hpp"
#include "maps/file_text.hpp"

namespace lodestar {
namespace {

std::string last_line_of(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) last = line;
  return last;
}

/// The files a child's output goes to, for posix_spawn().
class Redirection {
 public:
  Redirection(const std::filesystem::path& output_file, const std::filesystem::path& error_file) {
    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
    constexpr mode_t mode = 0644;
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, output_file.c_str(), flags, mode);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, error_file.c_str(), flags, mode);
  }
  ~Redirection() { posix_spawn_file_actions_destroy(&actions_); }
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

ProgramEnd run_program_to_end(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                              const std::filesystem::path& output_file,
                              const std::filesystem::path& error_file) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const std::vector<char*> pointers = argument_pointers(words);

  const Stopwatch watch;
  const Redirection redirection(output_file, error_file);
  pid_t child = 0;
  const int error =
      ::posix_spawn(&child, program.c_str(), redirection.get(), nullptr, pointers.data(), ::environ);
  if (error != 0) return {.why = fmt::format("it did not begin ({})", std::strerror(error))};
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  ProgramEnd end{.output = file_text(output_file).value_or(""),
                 .last_words = last_line_of(file_text(error_file).value_or("")),
                 .wall_s = watch.seconds()};
  if (WIFEXITED(status)) {
    end.exit_code = WEXITSTATUS(status);
  } else {
    end.why = fmt::format("signal {} ended it", WTERMSIG(status));
  }
  return end;
}

}  // namespace lodestar
