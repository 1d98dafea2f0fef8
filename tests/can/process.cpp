#include "tests/can/process.hpp"

#include <array>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>

#include "drivers/clock.hpp"

namespace lodestar {

using namespace std::chrono_literals;

Process::Process(std::vector<std::string> words, std::string log) : log_(std::move(log)) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  FileDescriptor reading(ends[0]);
  input_ = FileDescriptor(ends[1]);
  std::ofstream{log_};  // nobody reads what a process before it has printed
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  id_ = fork();
  if (id_ != 0) return;
  dup2(reading.get(), STDIN_FILENO);
  const int out = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

Process::~Process() {
  if (wait(Duration::zero())) return;
  signal(SIGCONT);
  signal(SIGKILL);
  wait(5s);
}

void Process::say(const std::string& line) {
  const std::string text = line + "\n";
  std::signal(SIGPIPE, SIG_IGN);
  if (write(input_.get(), text.data(), text.size()) < 0) throw std::runtime_error("nobody listens");
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
    } else if (monotonic_now() >= end) {
      break;
    } else {
      std::this_thread::sleep_for(5ms);
    }
  }
  return ended_;
}

std::string Process::end() {
  signal(SIGTERM);
  wait(5s);
  return output();
}

std::string Process::output() const {
  std::ostringstream text;
  text << std::ifstream(log_).rdbuf();
  return text.str();
}

bool shell(const std::string& line) {
  return std::system(line.c_str()) == 0;
}

}  // namespace lodestar
