#include "app/recording/can_log.hpp"

#include <utility>

#include "maps/input_error.hpp"

namespace lodestar {

CanLog::CanLog(std::filesystem::path file, const CanLogOptions& options)
    : file_(std::move(file)),
      out_(file_, std::ios::binary | std::ios::trunc),
      lines_(out_, options.interface),
      writer_(
          {.most_waiting = options.most_waiting,
           .can_wait = options.can_wait,
           .collect = std::chrono::milliseconds(100),  // a busy bus costs ten writes a second
           .tell = options.tell,
           .disk = options.disk},
          [this](const StampedCanFrame& frame) {
            check();
            lines_.write(frame);
          },
          [this] {
            out_.flush();
            check();
          }) {
  check();
}

void CanLog::check() const {
  if (!out_) throw InputError(file_, 0, "a file that cannot be written", "one that can");
}

}  // namespace lodestar
