#include "app/common/worker.hpp"

#include <algorithm>
#include <iterator>
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

/// Of those for which nobody waits any more, none keeps another from waiting.
std::optional<std::stop_source> Worker::give(Job job) {
  for (const Waiting& dropped : take_cancelled()) dropped.job(dropped.cancel.get_token());
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= most_waiting_ + (under_way_ ? 0 : 1)) return std::nullopt;
  std::stop_source cancel;
  waiting_.push_back({std::move(job), cancel});
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  given_.notify_one();
  return cancel;
}

std::vector<Worker::Waiting> Worker::take_cancelled() {
  const std::lock_guard lock(mutex_);
  const auto cancelled = std::ranges::stable_partition(
      waiting_, [](const Waiting& waiting) { return !waiting.cancel.stop_requested(); });
  std::vector<Waiting> taken(std::move_iterator(cancelled.begin()), std::move_iterator(cancelled.end()));
  waiting_.erase(cancelled.begin(), cancelled.end());
  return taken;
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
