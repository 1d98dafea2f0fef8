#include "app/fleet/action_hooks.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <fmt/format.h>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "app/common/spawn_attributes.hpp"

namespace lodestar {
namespace {

using Clock = std::chrono::steady_clock;

/// Between looks at a program that runs.
constexpr auto look_every = std::chrono::milliseconds(20);
/// From the polite end of a program to the certain one.
constexpr auto patience = std::chrono::seconds(2);
/// An order may ask for ten thousand actions at one node. Chosen by hand.
constexpr int most_at_once = 8;

/// An unnamed file in memory, which no program can keep waiting as a pipe would.
class MemoryFile {
 public:
  MemoryFile() : fd_(memfd_create("lodestar-action", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (fd_ >= 0) close(fd_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] bool hold(const std::string& text) const {
    return write(fd_, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
           lseek(fd_, 0, SEEK_SET) == 0;
  }
  /// What a master is shown of it.
  [[nodiscard]] std::string first_line() const {
    std::array<char, 200> bytes{};
    const ssize_t size = pread(fd_, bytes.data(), bytes.size(), 0);
    const std::string text(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    std::string line;
    for (const char c : text.substr(0, text.find('\n'))) line += c >= ' ' && c <= '~' ? c : '?';
    return line;
  }

 private:
  int fd_;
};

std::optional<pid_t> spawned(std::vector<std::string> command, const std::filesystem::path& folder, int in,
                             int out) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
  posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
  const SpawnAttributes attributes;
  const std::vector<char*> words = argument_pointers(command);
  pid_t pid = 0;
  const int error = posix_spawn(&pid, words.front(), &files, attributes.get(), words.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  return error == 0 ? std::optional(pid) : std::nullopt;
}

/// Asks it to end, and after two seconds makes it.
void end_group(pid_t pid) {
  kill(-pid, SIGTERM);
  const Clock::time_point until = Clock::now() + patience;
  while (Clock::now() < until && waitpid(pid, nullptr, WNOHANG) == 0) std::this_thread::sleep_for(look_every);
  kill(-pid, SIGKILL);
  waitpid(pid, nullptr, 0);  // an error where it has been waited for
}

HookResult result_of(const std::string& id, int status, const MemoryFile& out) {
  const std::string said = out.first_line();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return {.action_id = id, .succeeded = true, .words = said};
  std::string words = WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status))
                                        : fmt::format("ended by signal {}", WTERMSIG(status));
  if (!said.empty()) words += ": " + said;
  return {.action_id = id, .succeeded = false, .words = std::move(words)};
}

/// Nothing where nobody wants the result any more.
std::optional<HookResult> run_program(const std::stop_token& unwanted, const ActionHook& hook,
                                      const std::filesystem::path& folder, const FleetAction& action) {
  const auto failed = [&](std::string words) {
    return HookResult{.action_id = action.id, .succeeded = false, .words = std::move(words)};
  };
  const nlohmann::ordered_json request{
      {"actionId", action.id}, {"actionType", action.type}, {"parameters", action.parameters}};
  const MemoryFile in;
  const MemoryFile out;
  if (!in.hold(request.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n"))
    return failed("no memory for its input");
  const std::optional<pid_t> pid = spawned(hook.command, folder, in.fd(), out.fd());
  if (!pid) return failed(fmt::format("{} cannot be run", hook.command.front()));
  const Clock::time_point until = Clock::now() + std::chrono::duration_cast<Clock::duration>(hook.timeout);
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(*pid, &status, WNOHANG);
    if (ended == *pid) {
      kill(-*pid, SIGKILL);  // whatever it has left behind
      return result_of(action.id, status, out);
    }
    const bool is_late = Clock::now() >= until;
    if (is_late || unwanted.stop_requested()) {
      end_group(*pid);
      if (!is_late) return std::nullopt;
      return failed(fmt::format("not done after {:.3g} s", seconds(hook.timeout)));
    }
    std::this_thread::sleep_for(look_every);
  }
}

}  // namespace

struct ActionHooks::Shared {
  std::mutex mutex;  ///< of all below
  std::vector<HookResult> results;
  int running = 0;
  std::condition_variable ended;
};

ActionHooks::ActionHooks(std::vector<ActionHook> hooks, std::filesystem::path folder)
    : hooks_(std::move(hooks)), folder_(std::move(folder)), shared_(std::make_shared<Shared>()) {}

ActionHooks::~ActionHooks() {
  keep([](const std::string&) { return false; });
  std::unique_lock lock(shared_->mutex);
  shared_->ended.wait(lock, [this] { return shared_->running == 0; });
}

bool ActionHooks::carries_out(const std::string& type) const {
  return std::ranges::find(hooks_, type, &ActionHook::type) != hooks_.end();
}

/// The threads are detached: the control loop, which may have real-time priority, must not wait to join one.
void ActionHooks::start(const FleetAction& action) {
  const ActionHook& hook = *std::ranges::find(hooks_, action.type, &ActionHook::type);
  const std::stop_token unwanted = running_[action.id].get_token();
  {
    const std::lock_guard lock(shared_->mutex);
    if (shared_->running >= most_at_once) {
      shared_->results.push_back({.action_id = action.id, .words = "too many programs at once"});
      return;
    }
    ++shared_->running;
  }
  std::thread([shared = shared_, hook, folder = folder_, action, unwanted] {
    std::optional<HookResult> result = run_program(unwanted, hook, folder, action);
    const std::lock_guard lock(shared->mutex);
    if (result) shared->results.push_back(std::move(*result));
    --shared->running;
    shared->ended.notify_all();
  }).detach();
}

void ActionHooks::keep(const std::function<bool(const std::string& action_id)>& is_wanted) {
  std::erase_if(running_, [&](auto& one) { return !is_wanted(one.first) && one.second.request_stop(); });
}

std::vector<HookResult> ActionHooks::take_ended() {
  const std::unique_lock lock(shared_->mutex, std::try_to_lock);
  if (!lock) return {};
  return std::exchange(shared_->results, {});
}

}  // namespace lodestar
