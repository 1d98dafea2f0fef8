#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <type_traits>
#include <utility>

namespace lodestar {

/// Runs tasks in turn on a thread of its own. At its end it finishes the task at hand and drops those that
/// wait.
class TaskThread {
 public:
  TaskThread() : thread_([this](const std::stop_token& stop) { work(stop); }) {}

  /// The future has the task's result, or the exception that it threw. It may be dropped.
  template <typename Task>
  std::future<std::invoke_result_t<Task>> run(Task task) {
    using Packaged = std::packaged_task<std::invoke_result_t<Task>()>;
    const auto packaged = std::make_shared<Packaged>(std::move(task));  // std::function wants copies
    add([packaged] { (*packaged)(); });
    return packaged->get_future();
  }

 private:
  void add(std::function<void()> task);
  void work(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any has_task_;
  std::deque<std::function<void()>> tasks_;
  std::jthread thread_;  ///< the last member: it uses the others
};

}  // namespace lodestar
