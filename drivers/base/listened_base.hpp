#pragma once

#include <memory>
#include <optional>

#include "drivers/base/base_driver.hpp"
#include "drivers/base/base_protocol.hpp"
#include "drivers/can/can_bus.hpp"

namespace lodestar {

/// A base that another program drives: its feedback is read, and nothing is ever sent.
class ListenedBase {
 public:
  /// `max_age`: of the newest frame, for a base that is there.
  ListenedBase(CanBus& bus, std::unique_ptr<BaseProtocol> protocol,
               Duration max_age = std::chrono::milliseconds(300));

  /// Ready while frames come; with fault feedback_lost while none do.
  BaseFeedback poll(Stamp now);

 private:
  CanBus& bus_;
  std::unique_ptr<BaseProtocol> protocol_;
  Duration max_age_;
  BaseFeedback newest_;  ///< without its travel
};

}  // namespace lodestar
