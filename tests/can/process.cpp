#include "tests/can/process.hpp"

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <poll.h>
#include <stdexcept>
#include <string_view>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "app/commands/program.hpp"
#include "drivers/system/clock.hpp"

namespace lodestar {

using namespace std::chrono_literals;

namespace {

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    reading = FileDescriptor(ends[0]);
    writing = FileDescriptor(ends[1]);
  }

  FileDescriptor reading;
  FileDescriptor writing;
};

/// `lodestar` runs in the forked child without exec: User-Mode Linux takes seconds to load its 250 libraries,
/// which this program has loaded already.
[[noreturn]] void become(std::vector<char*>& arguments) {
  if (std::string_view(arguments[0]) != LODESTAR_BINARY) {
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  close_range(STDERR_FILENO + 1, ~0U, 0);  // as exec does
  const int exit_code = program(static_cast<int>(arguments.size()) - 1, arguments.data());
  std::fflush(nullptr);
  _exit(exit_code);  // without the parent's exit handlers
}

}  // namespace

Process::Process(std::vector<std::string> words) {
  Pipe in;
  Pipe out;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::fflush(nullptr);  // or the child would print the buffered output again
  id_ = fork();
  if (id_ == 0) {
    dup2(in.reading.get(), STDIN_FILENO);
    dup2(out.writing.get(), STDOUT_FILENO);
    dup2(out.writing.get(), STDERR_FILENO);
    become(arguments);
  }
  input_ = std::move(in.writing);
  printed_ = std::move(out.reading);
  thread_ = std::jthread([this](const std::stop_token& stop) { listen(stop); });
}

Process::~Process() {
  if (wait(Duration::zero())) return;
  signal(SIGCONT);
  signal(SIGKILL);
  wait(5s);
}

/// Reads until all writers have closed the pipe; children of the program may print after its end.
void Process::listen(const std::stop_token& stop) {
  std::string begun;
  while (!stop.stop_requested()) {
    const Stamp before = monotonic_now();
    pollfd source{.fd = printed_.get(), .events = POLLIN, .revents = 0};
    std::array<char, 4096> bytes{};
    const bool printed = ::poll(&source, 1, 20) > 0;
    const ssize_t size = printed ? ::read(printed_.get(), bytes.data(), bytes.size()) : 0;
    if (printed && size <= 0) break;
    const Stamp now = monotonic_now();
    begun.append(bytes.data(), static_cast<std::size_t>(size));
    const std::lock_guard lock(mutex_);
    for (std::size_t end = begun.find('\n'); end != std::string::npos; end = begun.find('\n')) {
      lines_.push_back({now, begun.substr(0, end)});
      begun.erase(0, end + 1);
    }
    if (static_cast<std::size_t>(size) < bytes.size())
      read_until_ = before;  // the pipe was empty after `before`
  }
  read_until_ = Stamp::max();
}

void Process::say(const std::string& line) {
  const std::string text = line + "\n";
  std::signal(SIGPIPE, SIG_IGN);
  (void)!write(input_.get(), text.data(), text.size());  // the program may have ended
}

void Process::signal(int number) const {
  if (!ended_) kill(id_, number);
}

std::optional<int> Process::wait(Duration longest) {
  const Stamp end = monotonic_now() + longest;
  while (!ended_) {
    int status = 0;
    if (waitpid(id_, &status, WNOHANG) == id_) {
      ended_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
      await_last_words();
    } else if (monotonic_now() >= end) {
      break;
    } else {
      std::this_thread::sleep_for(5ms);
    }
  }
  return ended_;
}

/// All that was printed before this call is in the output afterwards.
void Process::await_last_words() const {
  const Stamp ended = monotonic_now();
  while (read_until_.load() < ended) std::this_thread::sleep_for(1ms);
}

std::string Process::end() {
  signal(SIGTERM);
  wait(5s);
  return output();
}

std::string Process::output() const {
  const std::lock_guard lock(mutex_);
  std::string text;
  for (const Line& line : lines_) text += line.text + "\n";
  return text;
}

std::optional<Stamp> Process::said(const std::string& words, Stamp since) const {
  const std::lock_guard lock(mutex_);
  for (const Line& line : lines_) {
    if (line.stamp > since && line.text.find(words) != std::string::npos) return line.stamp;
  }
  return std::nullopt;
}

bool shell(const std::string& line) {
  return std::system(line.c_str()) == 0;
}

}  // namespace lodestar
