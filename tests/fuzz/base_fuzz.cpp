#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>

#include "drivers/base_driver.hpp"

namespace lodestar {
namespace {

/// Brings whatever it is given, and accepts all commands.
class FedBus : public CanBus {
 public:
  bool send(const CanFrame& frame) override {
    if (frame.length > frame.data.size()) __builtin_trap();
    return true;
  }

  std::optional<StampedCanFrame> poll() override {
    if (frames.empty()) return std::nullopt;
    const StampedCanFrame next = frames.front();
    frames.pop_front();
    return next;
  }

  std::deque<StampedCanFrame> frames;
};

constexpr std::size_t bytes_per_frame = 11;

/// Identifier among those of the protocol (or beside them), length, 8 bytes of data, milliseconds to the
/// next.
CanFrame frame_from(const std::uint8_t* bytes) {
  constexpr std::array<std::uint32_t, 8> ids{0x111, 0x211, 0x221, 0x311, 0x421, 0x441, 0x000, 0x7FF};
  CanFrame frame{ids[bytes[0] % ids.size()], static_cast<std::uint8_t>(bytes[1] % 9), {}};
  std::copy(bytes + 2, bytes + 10, frame.data.begin());
  return frame;
}

void drive(const std::uint8_t* data, std::size_t size) {
  FedBus bus;
  BaseDriver driver(bus);
  Stamp now(std::chrono::seconds(1));
  for (std::size_t at = 0; at + bytes_per_frame <= size; at += bytes_per_frame) {
    now += std::chrono::milliseconds(data[at + 10]);
    bus.frames.push_back({now, frame_from(data + at)});
    const BaseFeedback feedback = driver.poll(now);
    if (feedback.state == BaseState::fault && !feedback.fault) __builtin_trap();
    if (feedback.measured && !std::isfinite(feedback.measured->forward_mps)) __builtin_trap();
    driver.command({0.2, 0.1});
    if ((data[at] & 0x80) != 0) (void)driver.resume(now);
  }
}

}  // namespace
}  // namespace lodestar

// Whatever comes over the bus, the driver neither breaks nor is in a fault without saying which.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lodestar::drive(data, size);
  return 0;
}
