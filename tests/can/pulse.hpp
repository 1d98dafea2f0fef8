#pragma once

#include <mutex>
#include <thread>
#include <vector>

#include "maps/stamp.hpp"

namespace lodestar {

/// How well this machine runs: a thread that wants to wake every few milliseconds, before all others, and
/// notes by how much it overslept. A User-Mode Linux is a process among others of its host; whenever that has
/// other work, all clocks in here go on while nothing moves. A bound in milliseconds means something only
/// when that is taken out.
class Pulse {
 public:
  Pulse();
  ~Pulse();
  Pulse(const Pulse&) = delete;
  Pulse& operator=(const Pulse&) = delete;

  /// For so long in all nothing moved within [from, to].
  [[nodiscard]] Duration lost(Stamp from, Stamp to) const;

  /// The longest time within [from, to] for which nothing moved.
  [[nodiscard]] Duration longest_pause(Stamp from, Stamp to) const;

 private:
  struct Pause {
    Stamp begin;
    Stamp end;
  };

  void beat();

  mutable std::mutex mutex_;
  std::vector<Pause> pauses_;
  std::jthread thread_;
};

/// Of this program, from its start.
const Pulse& pulse();

}  // namespace lodestar
