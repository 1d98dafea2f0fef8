#include "app/frames/piped_program.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include "app/common/spawn_attributes.hpp"

namespace lodestar {
namespace {

constexpr int third_descriptor = 3;

struct Pipe {
  FileDescriptor reads;
  FileDescriptor writes;
};

/// Not inherited: a child gets its end by dup2. Above the child's own descriptors, so that none covers
/// another.
Pipe opened_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  Pipe pipe{.reads = FileDescriptor(ends[0]), .writes = FileDescriptor(ends[1])};
  if (pipe.writes.get() <= third_descriptor)
    pipe.writes = FileDescriptor(::fcntl(pipe.writes.get(), F_DUPFD_CLOEXEC, third_descriptor + 1));
  return pipe;
}

}  // namespace

PipedProgram::PipedProgram(std::vector<std::string> words) {
  Pipe output = opened_pipe();
  Pipe third = opened_pipe();
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output.writes.get(), STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, third.writes.get(), third_descriptor);
  const std::vector<char*> pointers = argument_pointers(words);
  const SpawnAttributes attributes;
  const int error =
      ::posix_spawnp(&pid_, pointers.front(), &files, attributes.get(), pointers.data(), ::environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::system_error(error, std::generic_category(), words.front());
  output_ = std::move(output.reads);
  third_ = std::move(third.reads);
}

PipedProgram::~PipedProgram() {
  ::kill(pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::string read_to_end(int descriptor) {
  std::string text;
  std::array<char, 4096> chunk{};
  for (;;) {
    const ssize_t count = ::read(descriptor, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(chunk.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace lodestar
