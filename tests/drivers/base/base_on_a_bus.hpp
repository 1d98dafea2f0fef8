#pragma once

#include <functional>
#include <optional>
#include <sstream>

#include "drivers/base/base_driver.hpp"
#include "drivers/can/candump.hpp"
#include "drivers/can/in_process_bus.hpp"
#include "drivers/simulation/simulated_base.hpp"
#include "drivers/simulation/simulated_motion.hpp"
#include "maps/random.hpp"

// A simulated base and a navigator's driver on one bus.
namespace lodestar::testing {

/// Loses frames at random, in both directions.
class LossyBus final : public CanBus {
 public:
  LossyBus(CanBus& bus, double loss) : bus_(bus), loss_(loss) {}
  bool send(const CanFrame& frame) override { return random_.uniform() < loss_ || bus_.send(frame); }
  std::optional<StampedCanFrame> poll() override {
    auto frame = bus_.poll();
    while (frame && random_.uniform() < loss_) frame = bus_.poll();
    return frame;
  }

 private:
  CanBus& bus_;
  double loss_;
  Random random_{9};
};

/// The base on one end of a bus, the navigator's driver on the other, connected by frames only.
struct World {
  explicit World(const SimulatedBaseOptions& options = {}, std::uint64_t seed = 1,
                 std::optional<SimulatedMotion::Surroundings> surroundings = std::nullopt, double loss = 0.0)
      : bus({.latency = options.can_latency}),
        navigator_end(bus.attach(), loss),
        motion(options, {}, seed, std::move(surroundings)),
        base(bus.attach(), motion, options) {
    bus.on_frame([this](const StampedCanFrame& frame) { log.write(frame); });
  }

  /// Runs for `time`; the navigator polls every 20 ms and sends its command, if any.
  void run(Duration time, const std::function<std::optional<BodyVelocity>()>& navigator) {
    for (const Stamp end = now + time; now < end;) {
      now += std::chrono::milliseconds(1);
      motion.step(std::chrono::milliseconds(1));
      bus.advance(now);
      base.step(now);
      if (now.time_since_epoch() % std::chrono::milliseconds(20) != Duration::zero()) continue;
      feedback = driver.poll(now);
      if (!feedback.travel.empty()) travel = feedback.travel.back();
      if (const auto velocity = navigator()) driver.command(*velocity);
    }
  }
  void drive(const BodyVelocity& velocity, Duration time) {
    run(time, [&] { return velocity; });
  }
  void wait(Duration time) {
    run(time, [] { return std::nullopt; });
  }

  const Pose2& truth() const { return motion.true_map_from_base(); }

  std::ostringstream log_text;
  CandumpWriter log{log_text};
  InProcessBus bus;
  LossyBus navigator_end;
  BaseDriver driver{navigator_end};
  SimulatedMotion motion;
  SimulatedBase base;
  Stamp now;
  BaseFeedback feedback;
  WheelTravel travel;
};

}  // namespace lodestar::testing
