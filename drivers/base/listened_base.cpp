#include "drivers/base/listened_base.hpp"

#include <utility>

namespace lodestar {

ListenedBase::ListenedBase(CanBus& bus, std::unique_ptr<BaseProtocol> protocol, Duration max_age)
    : bus_(bus), protocol_(std::move(protocol)), max_age_(max_age) {}

BaseFeedback ListenedBase::poll(Stamp now) {
  std::vector<WheelTravel> travel;
  while (const auto received = bus_.poll()) {
    const HeardFrame heard = protocol_->decode(*received);
    if (!heard.from_base) continue;
    newest_.last_heard = received->stamp;
    if (heard.system) newest_.system = heard.system;
    if (heard.measured) newest_.measured = heard.measured;
    if (heard.travel) travel.push_back(*heard.travel);
  }
  const bool is_there = newest_.last_heard && now - *newest_.last_heard <= max_age_;
  newest_.state = is_there ? BaseState::ready : BaseState::waiting_for_base;
  newest_.fault = is_there ? std::nullopt : std::optional(BaseFault::feedback_lost);
  BaseFeedback feedback = newest_;
  feedback.travel = std::move(travel);
  return feedback;
}

}  // namespace lodestar
