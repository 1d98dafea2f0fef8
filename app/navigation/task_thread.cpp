#include "app/navigation/task_thread.hpp"

namespace lodestar {

void TaskThread::add(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  has_task_.notify_one();
}

void TaskThread::work(const std::stop_token& stop) {
  for (;;) {
    std::unique_lock lock(mutex_);
    has_task_.wait(lock, stop, [this] { return !tasks_.empty(); });
    if (stop.stop_requested()) return;
    const std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
  }
}

}  // namespace lodestar
