#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace lodestar {

/// A progress bar on stderr; draws nothing when stderr is not a terminal or when `quiet`. Safe to call from
/// several threads.
class Progress {
 public:
  Progress(std::string what, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The completed share, 0..1. Cheap to call often.
  void show(double share);

 private:
  void draw(double share) const;

  std::mutex mutex_;
  std::string what_;
  bool visible_ = false;
  std::chrono::steady_clock::time_point last_drawn_;
};

}  // namespace lodestar
