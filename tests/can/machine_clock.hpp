#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace lodestar {

/// Nanoseconds, of the host's clock or of the machine's.
using Nanoseconds = std::int64_t;

struct MachineClockOptions {
  /// The machine's time for each second that its host spends on it. User-Mode Linux takes several times as
  /// long for a system call or a page fault as its host would; with 4 a mission's processes keep a control
  /// period of 20 ms on one busy core of 2 GHz.
  int host_seconds_a_second = 4;
  /// The host's time that counts at once: one tick of the kernel's (CONFIG_HZ=100). When longer passes
  /// between two looks at the clock, the host was doing something else.
  Nanoseconds longest_step = 10'000'000;
};

/// A clock that goes only while its machine runs, and the machine's one timer. It never passes the time at
/// which the timer is due before the interrupt was taken, and leaps there when nothing else is to be done. A
/// host that has other work thus makes the machine's day longer, but nothing in it late.
class MachineClock {
 public:
  explicit MachineClock(Nanoseconds host, const MachineClockOptions& options = {})
      : options_(options), seen_(host), now_(host) {}

  /// What the machine's clock says, when the host's says `host`. Each look moves it on by 1 ns at least, so
  /// that nobody waits for it forever.
  Nanoseconds look(Nanoseconds host) {
    const Nanoseconds passed = std::clamp<Nanoseconds>(host - seen_, 0, options_.longest_step);
    seen_ = host;
    const Nanoseconds next = now_ + 1;
    now_ = std::max(next, std::min(now_ + passed / options_.host_seconds_a_second, due_.value_or(INT64_MAX)));
    return now_;
  }

  /// The timer interrupts in `first`, from then on each `period`, or once when that is 0.
  void arm(Nanoseconds first, Nanoseconds period) {
    due_ = now_ + first;
    period_ = period;
  }

  void disarm() { due_.reset(); }

  /// The machine's time until the interrupt, at least 1 ns. Nothing: no timer is armed.
  [[nodiscard]] std::optional<Nanoseconds> until_due() const {
    if (!due_) return std::nullopt;
    return std::max<Nanoseconds>(*due_ - now_, 1);
  }

  /// The host's time that the machine takes until then if it works all the while.
  [[nodiscard]] std::optional<Nanoseconds> host_time_until_due() const {
    if (!due_) return std::nullopt;
    return *until_due() * options_.host_seconds_a_second;
  }

  /// There is nothing to do until the interrupt.
  void leap_to_due() { now_ = std::max(now_, due_.value_or(now_)); }

  /// Whether there is an interrupt to be taken now; asking takes it.
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
