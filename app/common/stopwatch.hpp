#pragma once

#include <chrono>

namespace lodestar {

/// Wall time since construction, for benches and reports.
class Stopwatch {
 public:
  [[nodiscard]] std::chrono::nanoseconds elapsed() const { return std::chrono::steady_clock::now() - start_; }
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(elapsed()).count(); }
  [[nodiscard]] double microseconds() const { return 1e6 * seconds(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Wall time that a piece of work takes.
template <typename Work>
double microseconds_of(const Work& work) {
  const Stopwatch watch;
  work();
  return watch.microseconds();
}

}  // namespace lodestar
