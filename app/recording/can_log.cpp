#include "app/recording/can_log.hpp"

#include <fmt/format.h>
#include <fstream>
#include <utility>

#include "drivers/can/candump.hpp"

namespace lodestar {

CanLog::CanLog(std::filesystem::path file, std::string interface,
               std::function<void(const std::string&)> tell)
    : file_(std::move(file)),
      interface_(std::move(interface)),
      tell_(std::move(tell)),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

CanLog::~CanLog() = default;

void CanLog::take(const StampedCanFrame& frame) {
  const std::lock_guard lock(mutex_);
  if (!ended_) frames_.push_back(frame);
}

std::vector<StampedCanFrame> CanLog::taken() {
  const std::lock_guard lock(mutex_);
  return std::exchange(frames_, {});
}

void CanLog::work(const std::stop_token& stop) {
  constexpr auto period = std::chrono::milliseconds(100);
  std::ofstream out(file_, std::ios::binary);
  CandumpWriter writer(out, interface_);
  for (bool is_last = false; out && !is_last;) {
    is_last = stop.stop_requested();  // asked before the last frames are fetched
    for (const StampedCanFrame& frame : taken()) writer.write(frame);
    out.flush();
    if (!is_last) std::this_thread::sleep_for(period);
  }
  if (out) return;
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    frames_.clear();
  }
  tell_(fmt::format("{}: cannot be written", file_.string()));
}

}  // namespace lodestar
