#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "app/drive/finding.hpp"
#include "drivers/base/base_protocol.hpp"

namespace lodestar {

/// What a base has sent while the doctor listened.
struct HeardBase {
  struct Kind {
    int count = 0;
    Stamp newest;
  };

  void take(const StampedCanFrame& received, const HeardFrame& said);

  std::map<std::uint32_t, Kind> kinds;  ///< all frames, by identifier
  std::optional<Stamp> newest;          ///< of the base's own
  std::optional<SystemState> system;
  int states = 0;            ///< system states
  int counter_advances = 0;  ///< of them, those whose counter differs from the one before
  bool reports_motion = false;
  bool reports_travel = false;
  int other_masters = 0;  ///< motion commands
  int odd = 0;
};

/// Whether the base sends what a run needs, in which state it is, and who else commands it. `ignored_bits`:
/// fault bits that do not stop this robot, besides the protocol's warnings.
std::vector<Finding> look_at_base(const HeardBase& heard, const BaseProtocol& protocol,
                                  std::uint32_t ignored_bits);

}  // namespace lodestar
