#include "app/common/worker.hpp"

#include <utility>

#include "app/common/low_priority.hpp"

namespace lodestar {

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    if (under_way_) under_way_->request_stop();
  }
  given_.notify_one();
  if (thread_.joinable()) thread_.join();
}

std::optional<std::stop_source> Worker::give(Job job) {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= most_waiting_ + (under_way_ ? 0 : 1)) return std::nullopt;
  std::stop_source cancel;
  waiting_.push_back({std::move(job), cancel});
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  given_.notify_one();
  return cancel;
}

void Worker::work() {
  lower_priority_of_this_thread();
  std::unique_lock lock(mutex_);
  for (;;) {
    given_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (ends_) return;
    do_next(lock);
  }
}

void Worker::do_next(std::unique_lock<std::mutex>& lock) {
  const Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  under_way_ = next.cancel;
  lock.unlock();
  next.job(next.cancel.get_token());
  lock.lock();
  under_way_.reset();
}

}  // namespace lodestar
