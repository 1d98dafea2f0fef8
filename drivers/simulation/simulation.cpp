#include "drivers/simulation/simulation.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "drivers/can/in_process_bus.hpp"
#include "drivers/simulation/disturbed_ceiling.hpp"
#include "drivers/simulation/fault_schedule.hpp"
#include "drivers/simulation/faulty_bus.hpp"
#include "drivers/simulation/faulty_camera.hpp"
#include "drivers/simulation/faulty_scanner.hpp"
#include "drivers/simulation/simulated_camera.hpp"
#include "drivers/simulation/simulated_motion.hpp"
#include "maps/input_error.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

// Each purpose has its own random stream derived from the seed.
constexpr std::uint64_t slip_stream = 1;
constexpr std::uint64_t camera_stream = 2;
constexpr std::uint64_t schedule_stream = 3;
constexpr std::uint64_t bad_camera_stream = 4;
constexpr std::uint64_t bad_bus_stream = 5;
constexpr std::uint64_t lamps_stream = 6;
constexpr std::uint64_t kidnapping_stream = 7;
constexpr std::uint64_t scanner_stream = 8;
constexpr std::uint64_t people_stream = 9;
constexpr std::uint64_t bad_scanner_stream = 10;
constexpr std::uint64_t depth_stream = 11;

/// Between looks at the discs: at 2 m/s one moves by 2 cm, and straight on to a fraction of a millimetre.
constexpr Duration disc_period = std::chrono::milliseconds(10);

std::uint64_t seed_for(std::uint64_t seed, std::uint64_t purpose) {
  return Random(seed).stream(purpose).bits();
}

ContactJudgeOptions contact_options(const SimulationOptions& options) {
  ContactJudgeOptions contacts = options.contacts;
  if (!options.scanner) return contacts;
  contacts.base_from_scanner = options.scanner->mount.base_from_scanner;
  contacts.range_m = options.scanner->range_m;
  contacts.scan_period = from_seconds(1.0 / options.scanner->rate_hz);
  contacts.scan_delay = options.scanner->delay;
  return contacts;
}

/// They walk up to the disc that an outline holds at every heading.
PeopleOptions people_about(const SimulationOptions& options) {
  PeopleOptions people = options.people;
  people.robot_radius_m =
      options.robot_footprint ? options.robot_footprint->inner_radius_m() : options.robot_radius_m;
  return people;
}

}  // namespace

struct Simulation::World {
  /// `open` is the map as the scanner's beams meet it, `map` as the robot does.
  World(const OccupancyMap& open, const OccupancyMap& map, const MarkerRegistry& surveyed,
        const CameraModel& camera_model, const SimulationOptions& chosen)
      : options(chosen),
        registry(surveyed),
        bus({.latency = chosen.base.can_latency}),
        navigator_end(bus.attach()),
        base_end(bus.attach()),
        motion(chosen.base, chosen.start, seed_for(chosen.seed, slip_stream),
               SimulatedMotion::Surroundings{map, chosen.robot_radius_m, chosen.robot_footprint}),
        base(base_end, motion, chosen.base),
        camera(registry, camera_model, chosen.base_from_camera, chosen.camera,
               seed_for(chosen.seed, camera_stream)),
        faulty_camera(camera, seed_for(chosen.seed, bad_camera_stream)),
        faulty_bus(navigator_end, seed_for(chosen.seed, bad_bus_stream)),
        faults(chosen.faults, seed_for(chosen.seed, schedule_stream)),
        scorer(map, chosen.robot_radius_m, chosen.robot_footprint, contact_options(chosen)) {
    if (options.physics_step <= Duration::zero()) {
      throw InputError(
          fmt::format("physics step: found {} s, wanted a positive time", seconds(options.physics_step)));
    }
    camera.observe(now, motion.true_map_from_base());
    scorer.record({now, motion.true_map_from_base()});
    next_record += options.scoring_period;
    if (options.scanner) {
      scanner.emplace(open, *options.scanner, seed_for(chosen.seed, scanner_stream));
      faulty_scanner.emplace(*scanner, seed_for(chosen.seed, bad_scanner_stream));
    }
    if (options.depth_camera)
      depth_camera.emplace(open, options.overhangs, *options.depth_camera,
                           seed_for(chosen.seed, depth_stream));
    if (options.people.count > 0)
      people.emplace(map, people_about(options), options.start, seed_for(chosen.seed, people_stream));
    if (options.battery) battery.emplace(*options.battery);
    for (const MovingDisc& disc : options.discs) trajectories.emplace_back(disc);
    for (const SlidingDoor& door : options.doors) leaves.emplace_back(door);
    move_discs();
  }

  void step() {
    if (faults.advance(now, motion.true_map_from_base().position_m, registry)) suffer();
    motion.step(options.physics_step);
    now += options.physics_step;
    bus.advance(now);
    faulty_bus.advance(now);
    faulty_camera.advance(now);
    if (faulty_scanner) faulty_scanner->advance(now);
    if (battery) {
      battery->step(options.physics_step, base.is_told_to_move(), motion.true_map_from_base());
      base.set_battery_v(battery->voltage_v());
    }
    base.step(now);
    camera.observe(now, motion.true_map_from_base());
    if (now >= next_discs) move_discs();
    score();
  }

  void move_discs() {
    const bool is_empty = trajectories.empty() && leaves.empty() && !people && options.others.empty();
    if (!scanner && !depth_camera && is_empty) return;
    next_discs += disc_period;
    move_doors();
    discs.clear();
    for (FollowedTrajectory& trajectory : trajectories) discs.push_back(trajectory.at(now));
    for (const SlidingLeaf& leaf : leaves)
      discs.insert(discs.end(), leaf.discs().begin(), leaf.discs().end());
    discs.insert(discs.end(), options.others.begin(), options.others.end());
    if (people) {
      people->step(disc_period, motion.true_map_from_base(), discs);
      for (const Walker& walker : people->walkers()) discs.push_back(walker.disc);
    }
    if (scanner) scanner->observe(now, motion.true_map_from_base(), discs);
    if (depth_camera) depth_camera->observe(now, motion.true_map_from_base(), discs);
    scorer.record_discs({now, motion.true_map_from_base()}, discs);
  }

  void move_doors() {
    if (leaves.empty()) return;
    std::vector<Vec2> present_m{motion.true_map_from_base().position_m};
    for (const DiscState& other : options.others) present_m.push_back(other.position_m);
    if (people)
      for (const Walker& walker : people->walkers()) present_m.push_back(walker.disc.position_m);
    for (SlidingLeaf& leaf : leaves) leaf.step(now, disc_period, present_m);
  }

  /// Applies the active faults to all parts.
  void suffer() {
    const std::vector<Fault> active = faults.active();
    camera.rehang(disturbed(registry, active),
                  decoy_lamps(registry, active, seed_for(options.seed, lamps_stream)));
    faulty_camera.suffer(active);
    faulty_bus.suffer(active);
    if (faulty_scanner) faulty_scanner->suffer(active);
    if (options.disk) options.disk->suffer(active);
    const auto slip = std::ranges::find(active, FaultKind::wheel_slip, &Fault::kind);
    motion.slip(slip != active.end() ? slip->left_share : 0.0,
                slip != active.end() ? slip->right_share : 0.0);
    base.defects().left_encoder_stuck =
        std::ranges::find(active, FaultKind::encoder_stuck, &Fault::kind) != active.end();
    for (const Fault& fault : faults.begun()) {
      if (fault.kind != FaultKind::kidnapping) continue;
      motion.carry_off(fault.shift_m, fault.turn_rad, Random(seed_for(options.seed, kidnapping_stream)));
    }
  }

  void score() {
    was_blocked = was_blocked || motion.is_blocked();
    if (now < next_record) return;
    next_record += options.scoring_period;
    scorer.record({now, motion.true_map_from_base()}, std::exchange(was_blocked, false));
  }

  SimulationOptions options;
  MarkerRegistry registry;
  Stamp now;
  Stamp wanted;  ///< time that all calls of advance() add up to
  InProcessBus bus;
  CanBus& navigator_end;
  CanBus& base_end;
  SimulatedMotion motion;
  SimulatedBase base;
  SimulatedCamera camera;
  FaultyCamera faulty_camera;
  FaultyBus faulty_bus;
  FaultSchedule faults;
  Scorer scorer;
  Stamp next_record;
  std::optional<SimulatedScanner> scanner;
  std::optional<FaultyScanner> faulty_scanner;
  std::optional<SimulatedDepthCamera> depth_camera;
  std::vector<FollowedTrajectory> trajectories;
  std::vector<SlidingLeaf> leaves;
  std::optional<Walkers> people;
  std::optional<SimulatedBattery> battery;
  std::vector<DiscState> discs;
  Stamp next_discs;
  bool was_blocked = false;
};

Simulation::Simulation(const OccupancyMap& map, const MarkerRegistry& registry, const CameraModel& camera,
                       const SimulationOptions& options)
    : world_(std::make_unique<World>(map, with_overhangs(map, options.overhangs, options.robot_height_m),
                                     registry, camera, options)) {}

Simulation::~Simulation() = default;

void Simulation::advance(Duration by) {
  world_->wanted += by;
  while (world_->now + world_->options.physics_step <= world_->wanted) world_->step();
}

Stamp Simulation::now() const {
  return world_->now;
}

Camera& Simulation::camera() {
  return world_->faulty_camera;
}

CanBus& Simulation::can() {
  return world_->faulty_bus;
}

Scanner* Simulation::scanner() {
  return world_->faulty_scanner ? &*world_->faulty_scanner : nullptr;
}

DepthCamera* Simulation::depth_camera() {
  return world_->depth_camera ? &*world_->depth_camera : nullptr;
}

const std::vector<DiscState>& Simulation::discs() const {
  return world_->discs;
}

SimulatedBase& Simulation::base() {
  return world_->base;
}

void Simulation::move_others(std::span<const DiscState> others) {
  if (others.size() != world_->options.others.size())
    throw InputError(
        fmt::format("others: found {}, wanted {}", others.size(), world_->options.others.size()));
  world_->options.others.assign(others.begin(), others.end());
}

void Simulation::push(const Pose2& by) {
  world_->motion.push(by);
}

void Simulation::change_map(const OccupancyMap& map) {
  const OccupancyMap solid = with_overhangs(map, world_->options.overhangs, world_->options.robot_height_m);
  world_->motion.change_surroundings(solid);
  world_->scorer.change_map(solid);
  if (world_->scanner) world_->scanner->change_map(map);
  if (world_->depth_camera) world_->depth_camera->change_map(map);
}

void Simulation::on_can_frame(std::function<void(const StampedCanFrame&)> listener) {
  world_->bus.on_frame(std::move(listener));
}

std::vector<FaultEvent> Simulation::faults() const {
  return world_->faults.events();
}

Scorer& Simulation::scorer() {
  return world_->scorer;
}

}  // namespace lodestar
