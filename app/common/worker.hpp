#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

namespace lodestar {

/// Does jobs one after the other on a thread of its own, for a thread that must not wait for them. The thread
/// starts with the first job and has the console's low priority.
class Worker {
 public:
  /// A job that takes long looks at its token, and ends early when it has been cancelled: nobody waits for
  /// its result any more. It must not throw.
  using Job = std::function<void(const std::stop_token& cancelled)>;

  /// `most_waiting`: jobs accepted while one is under way.
  explicit Worker(std::size_t most_waiting) : most_waiting_(most_waiting) {}
  /// Cancels the job under way and waits for its end; those that wait are dropped.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// What cancels this job; nothing when too many wait already. A job that is cancelled before its turn is
  /// called all the same, to tell whoever waits for it: at its turn, or before it on the thread that gives
  /// another.
  [[nodiscard]] std::optional<std::stop_source> give(Job job);

 private:
  struct Waiting {
    Job job;
    std::stop_source cancel;
  };

  std::vector<Waiting> take_cancelled();
  void work();
  void do_next(std::unique_lock<std::mutex>& lock);

  std::size_t most_waiting_;
  std::mutex mutex_;  ///< of all below but the thread
  std::condition_variable given_;
  std::deque<Waiting> waiting_;
  std::optional<std::stop_source> under_way_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace lodestar
