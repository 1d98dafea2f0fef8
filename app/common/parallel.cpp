#include "app/common/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lodestar {

void in_parallel(int count, const std::function<void(int i)>& work) {
  std::atomic<int> next = 0;
  std::mutex failure_mutex;
  std::exception_ptr failure;
  const auto work_on = [&] {
    try {
      for (int i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> workers;
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    for (int i = 0; i < std::min(cores, count); ++i) workers.emplace_back(work_on);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace lodestar
