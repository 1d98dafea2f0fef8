#include "drivers/simulation/simulated_disk.hpp"

#include <algorithm>

namespace lodestar {

void SimulatedDisk::suffer(const std::vector<Fault>& active) {
  full_ = std::ranges::find(active, FaultKind::disk_full, &Fault::kind) != active.end();
  const auto slow = std::ranges::find(active, FaultKind::disk_slow, &Fault::kind);
  delay_s_ = slow != active.end() ? slow->delay_s : 0.0;
}

}  // namespace lodestar
