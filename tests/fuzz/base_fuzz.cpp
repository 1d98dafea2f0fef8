#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>

#include "drivers/base/base_driver.hpp"

namespace lodestar {
namespace {

constexpr BodyVelocity commanded{0.2, 0.1};

/// Delivers any frames, and accepts only those that may be sent: the one command given, and the frames of a
/// handshake and a stop. Received frames must not cause any others.
class FedBus : public CanBus {
 public:
  explicit FedBus(const BaseProtocol& protocol) {
    for (const auto& known :
         {protocol.command(commanded), protocol.stop(), protocol.enable(), protocol.clear_faults()}) {
      meant_.insert(meant_.end(), known.begin(), known.end());
    }
  }

  bool send(const CanFrame& frame) override {
    if (std::ranges::find(meant_, frame) == meant_.end()) __builtin_trap();
    return true;
  }

  std::optional<StampedCanFrame> poll() override {
    if (frames.empty()) return std::nullopt;
    const StampedCanFrame next = frames.front();
    frames.pop_front();
    return next;
  }

  std::deque<StampedCanFrame> frames;

 private:
  std::vector<CanFrame> meant_;
};

constexpr std::size_t bytes_per_frame = 11;

using Identifiers = std::array<std::uint32_t, 8>;
constexpr Identifiers of_agilex{0x111, 0x211, 0x221, 0x311, 0x421, 0x441, 0x000, 0x7FF};
constexpr Identifiers of_odrive{0x001, 0x021, 0x009, 0x029, 0x00D, 0x02D, 0x007, 0x7FF};

/// Input of one frame: index of its ID (the protocol's or another), length, 8 bytes of data, milliseconds to
/// the next.
CanFrame frame_from(const std::uint8_t* bytes, const Identifiers& ids) {
  CanFrame frame{ids[bytes[0] % ids.size()], static_cast<std::uint8_t>(bytes[1] % 9), {}};
  std::copy(bytes + 2, bytes + 10, frame.data.begin());
  return frame;
}

void drive(const std::uint8_t* data, std::size_t size, std::unique_ptr<BaseProtocol> protocol,
           const Identifiers& ids) {
  FedBus bus(*protocol);
  BaseDriver driver(bus, std::move(protocol));
  Stamp now(std::chrono::seconds(1));
  for (std::size_t at = 0; at + bytes_per_frame <= size; at += bytes_per_frame) {
    now += std::chrono::milliseconds(data[at + 10]);
    bus.frames.push_back({now, frame_from(data + at, ids)});
    const BaseFeedback feedback = driver.poll(now);
    if (feedback.state == BaseState::fault && !feedback.fault) __builtin_trap();
    if (feedback.measured && !std::isfinite(feedback.measured->forward_mps)) __builtin_trap();
    for (const WheelTravel& travel : feedback.travel) {
      if (!std::isfinite(travel.left_m) || !std::isfinite(travel.right_m)) __builtin_trap();
    }
    driver.command(commanded);
    if ((data[at] & 0x80) != 0) (void)driver.resume(now);
  }
}

}  // namespace
}  // namespace lodestar

// Whatever arrives on the bus, the driver does not crash, and names every fault that it is in.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lodestar::drive(data, size, lodestar::make_agilex_protocol(), lodestar::of_agilex);
  lodestar::drive(data, size, lodestar::make_odrive_protocol({}), lodestar::of_odrive);
  return 0;
}
