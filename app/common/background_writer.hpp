#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "maps/stamp.hpp"

namespace lodestar {

/// How a simulated disk is; left out, the real one shows it.
struct DiskState {
  std::function<bool()> is_full;
  std::function<Duration()> delay;  ///< of each write
};

struct BackgroundWriterOptions {
  /// Items are accepted while those that wait, the one being written among them, are smaller than this
  /// together. Without sizes of their own they count one each.
  std::size_t most_waiting = 1;
  bool can_wait = false;  ///< put() waits for room, as a simulated drive may; otherwise it drops the item
  Duration collect{};     ///< items that come within this time are written together, with one flush
  std::function<void(const std::string&)> tell;  ///< told of the first error, once, from the writer's thread
  DiskState disk;
};

/// What has become of the items. Each is counted once.
struct WriterCounts {
  std::size_t written = 0;
  std::size_t dropped = 0;  ///< there was no room for them
  std::size_t failed = 0;   ///< writing them threw
  std::string error;        ///< the first; empty when there was none

  [[nodiscard]] bool complete() const { return dropped == 0 && failed == 0 && error.empty(); }
  /// What is missing and why, for people; empty when nothing is.
  [[nodiscard]] std::string loss(const std::string& name) const;
};

/// Writes items in their order on a thread of its own, so that no disk holds up the thread that drives: put()
/// takes a lock that is never held while something is written. Memory is bounded by `most_waiting` and one
/// item more. An item whose write throws is lost and the next is tried all the same: a disk may get room
/// again. The thread starts with the first item.
template <typename Item>
class BackgroundWriter {
 public:
  using Write = std::function<void(Item&)>;
  using Flush = std::function<void()>;  ///< called whenever nothing waits any more

  BackgroundWriter(BackgroundWriterOptions options, Write write, Flush flush = {})
      : options_(std::move(options)), write_(std::move(write)), flush_(std::move(flush)) {}
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;
  /// Waits until what was accepted is written.
  ~BackgroundWriter() { finish(); }

  /// False when the item was dropped. May be called from several threads.
  bool put(Item item, std::size_t size = 1) {
    const bool disk_is_full = options_.disk.is_full && options_.disk.is_full();
    std::unique_lock lock(mutex_);
    if (options_.can_wait && !disk_is_full) room_.wait(lock, [this] { return has_room() || ends_; });
    if (disk_is_full && counts_.error.empty()) counts_.error = "the disk is full";
    if (disk_is_full || !has_room() || ends_) {
      ++counts_.dropped;
      return false;
    }
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    waiting_.push_back({std::move(item), size});
    waiting_size_ += size;
    if (!collecting_ || !has_room()) work_.notify_one();
    return true;
  }

  /// Would an item be accepted now? While one thread puts, the answer holds until it does.
  [[nodiscard]] bool accepts() const {
    const std::lock_guard lock(mutex_);
    return has_room() && !ends_;
  }

  /// Waits until what was accepted is written; nothing is accepted after that. For one thread.
  WriterCounts finish() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    work_.notify_all();
    room_.notify_all();
    if (thread_.joinable()) thread_.join();
    return counts();
  }

  [[nodiscard]] WriterCounts counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  struct Waiting {
    Item item;
    std::size_t size = 1;
  };

  [[nodiscard]] bool has_room() const { return waiting_size_ < options_.most_waiting; }

  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      work_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      collecting_ = true;
      work_.wait_for(lock, options_.collect, [this] { return ends_ || !has_room(); });
      collecting_ = false;
      while (!waiting_.empty()) write_next(lock);
      lock.unlock();
      const std::string error = error_of([this] { flush(); });
      lock.lock();
      remember(error, lock);
    }
  }

  void write_next(std::unique_lock<std::mutex>& lock) {
    std::size_t size = 0;
    std::string error;
    {
      Waiting next = std::move(waiting_.front());
      waiting_.pop_front();
      size = next.size;
      lock.unlock();
      error = error_of([&] { write_(next.item); });
    }  // given back without the lock
    lock.lock();
    waiting_size_ -= size;
    ++(error.empty() ? counts_.written : counts_.failed);
    remember(error, lock);
    if (options_.can_wait) room_.notify_all();
  }

  void flush() {
    if (options_.disk.delay) std::this_thread::sleep_for(options_.disk.delay());
    if (flush_) flush_();
  }

  template <typename Work>
  static std::string error_of(const Work& work) {
    try {
      work();
      return {};
    } catch (const std::exception& error) {
      const std::string words = error.what();
      return words.empty() ? "an error without words" : words;
    }
  }

  void remember(const std::string& error, std::unique_lock<std::mutex>& lock) {
    if (error.empty() || !counts_.error.empty()) return;
    counts_.error = error;
    if (!options_.tell) return;
    lock.unlock();
    options_.tell(error);
    lock.lock();
  }

  BackgroundWriterOptions options_;
  Write write_;
  Flush flush_;
  mutable std::mutex mutex_;  ///< of all below but the thread
  std::condition_variable work_;
  std::condition_variable room_;
  std::deque<Waiting> waiting_;
  std::size_t waiting_size_ = 0;  ///< of the item being written too
  bool collecting_ = false;
  bool ends_ = false;
  WriterCounts counts_;
  std::thread thread_;
};

}  // namespace lodestar
