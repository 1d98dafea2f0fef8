#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace lodestar {

/// Nanoseconds, of the host's clock or of the virtual machine's.
using Nanoseconds = std::int64_t;

struct MachineClockOptions {
  /// Host seconds for one second of the machine's time. User-Mode Linux takes several times as long for a
  /// system call or a page fault as its host would; with 4, a mission's processes keep a control period of 20
  /// ms on one busy core of 2 GHz.
  int host_seconds_a_second = 4;
  /// Host time between two reads of the clock counts up to this: one tick of the kernel (CONFIG_HZ=100). When
  /// more passes, the host was doing other work.
  Nanoseconds longest_step = 10'000'000;
};

/// A clock that runs only while its machine runs, with the machine's one timer. It stops at the timer's due
/// time until the interrupt is taken, and jumps there when the machine is idle. Other work on the host thus
/// slows the machine down, but nothing in it is late.
class MachineClock {
 public:
  explicit MachineClock(Nanoseconds host, const MachineClockOptions& options = {})
      : options_(options), seen_(host), now_(host) {}

  /// The machine's time when the host's is `host`. Each read advances it by at least 1 ns, so that a busy
  /// wait for a time ends.
  Nanoseconds look(Nanoseconds host) {
    const Nanoseconds passed = std::clamp<Nanoseconds>(host - seen_, 0, options_.longest_step);
    seen_ = host;
    const Nanoseconds next = now_ + 1;
    now_ = std::max(next, std::min(now_ + passed / options_.host_seconds_a_second, due_.value_or(INT64_MAX)));
    return now_;
  }

  /// The timer interrupts after `first`, then every `period`; only once when that is 0.
  void arm(Nanoseconds first, Nanoseconds period) {
    due_ = now_ + first;
    period_ = period;
  }

  void disarm() { due_.reset(); }

  /// Machine time until the interrupt, at least 1 ns; nothing when no timer is armed.
  [[nodiscard]] std::optional<Nanoseconds> until_due() const {
    if (!due_) return std::nullopt;
    return std::max<Nanoseconds>(*due_ - now_, 1);
  }

  /// Host time until the interrupt if the machine is busy throughout.
  [[nodiscard]] std::optional<Nanoseconds> host_time_until_due() const {
    if (!due_) return std::nullopt;
    return *until_due() * options_.host_seconds_a_second;
  }

  /// The machine is idle until the interrupt.
  void leap_to_due() { now_ = std::max(now_, due_.value_or(now_)); }

  /// True when an interrupt is due; the call takes it.
  bool take_interrupt() {
    if (!due_ || now_ < *due_) return false;
    if (period_ > 0) {
      due_ = now_ + period_;
    } else {
      due_.reset();
    }
    return true;
  }

 private:
  MachineClockOptions options_;
  Nanoseconds seen_;  ///< on the host's clock
  Nanoseconds now_;
  std::optional<Nanoseconds> due_;
  Nanoseconds period_ = 0;
};

}  // namespace lodestar
