#include "app/common/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/core.h>
#include <unistd.h>

namespace lodestar {

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)), visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (visible_) fmt::print(stderr, "\r\033[K");
}

void Progress::show(double share) {
  if (!visible_) return;
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  constexpr std::chrono::milliseconds between_draws(100);
  if (now - last_drawn_ < between_draws) return;
  last_drawn_ = now;
  draw(share);
}

void Progress::draw(double share) const {
  constexpr int width = 40;
  const int filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * width);
  fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3.0f} %", what_, "", filled, "", width - filled, 100.0 * share);
  std::fflush(stderr);
}

}  // namespace lodestar
