#include "drivers/simulation.hpp"

#include <fmt/format.h>
#include <utility>

#include "drivers/in_process_bus.hpp"
#include "drivers/simulated_camera.hpp"
#include "drivers/simulated_motion.hpp"
#include "maps/input_error.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

// Each purpose draws from its own stream of the seed.
constexpr std::uint64_t slip_stream = 1;
constexpr std::uint64_t camera_stream = 2;

std::uint64_t seed_for(std::uint64_t seed, std::uint64_t purpose) {
  return Random(seed).stream(purpose).bits();
}

}  // namespace

struct Simulation::World {
  World(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera_model,
        const SimulationOptions& chosen)
      : options(chosen),
        bus({.latency = chosen.base.can_latency}),
        navigator_end(bus.attach()),
        base_end(bus.attach()),
        motion(chosen.base, chosen.start, seed_for(chosen.seed, slip_stream),
               SimulatedMotion::Surroundings{map, chosen.robot_radius_m}),
        base(base_end, motion, chosen.base),
        camera(registry, camera_model, chosen.base_from_camera, chosen.camera,
               seed_for(chosen.seed, camera_stream)),
        scorer(map, chosen.robot_radius_m) {
    if (options.physics_step <= Duration::zero()) {
      throw InputError(
          fmt::format("physics step: found {} s, wanted a positive time", seconds(options.physics_step)));
    }
    camera.observe(now, motion.true_map_from_base());
    scorer.record({now, motion.true_map_from_base()});
    next_record += options.scoring_period;
  }

  void step() {
    motion.step(options.physics_step);
    now += options.physics_step;
    bus.advance(now);
    base.step(now);
    camera.observe(now, motion.true_map_from_base());
    score();
  }

  void score() {
    was_blocked = was_blocked || motion.is_blocked();
    if (now < next_record) return;
    next_record += options.scoring_period;
    scorer.record({now, motion.true_map_from_base()}, std::exchange(was_blocked, false));
  }

  SimulationOptions options;
  Stamp now;
  Stamp wanted;  ///< that all calls of advance() so far add up to
  InProcessBus bus;
  CanBus& navigator_end;
  CanBus& base_end;
  SimulatedMotion motion;
  SimulatedBase base;
  SimulatedCamera camera;
  Scorer scorer;
  Stamp next_record;
  bool was_blocked = false;
};

Simulation::Simulation(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
                       const SimulationOptions& options)
    : world_(std::make_unique<World>(map, registry, camera, options)) {}

Simulation::~Simulation() = default;

void Simulation::advance(Duration by) {
  world_->wanted += by;
  while (world_->now + world_->options.physics_step <= world_->wanted) world_->step();
}

Stamp Simulation::now() const {
  return world_->now;
}

Camera& Simulation::camera() {
  return world_->camera;
}

CanBus& Simulation::can() {
  return world_->navigator_end;
}

SimulatedBase& Simulation::base() {
  return world_->base;
}

void Simulation::push(const Pose2& by) {
  world_->motion.push(by);
}

void Simulation::change_map(const OccupancyMap& map) {
  world_->motion.change_surroundings(map);
  world_->scorer.change_map(map);
}

void Simulation::on_can_frame(std::function<void(const StampedCanFrame&)> listener) {
  world_->bus.on_frame(std::move(listener));
}

Scorer& Simulation::scorer() {
  return world_->scorer;
}

}  // namespace lodestar
