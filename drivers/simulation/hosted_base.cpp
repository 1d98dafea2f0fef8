#include "drivers/simulation/hosted_base.hpp"

#include <array>
#include <fmt/format.h>
#include <utility>

#include "drivers/base/agilex_v2_table.hpp"
#include "drivers/base/odrive_table.hpp"
#include "drivers/can/can_interface.hpp"
#include "drivers/can/socketcan_bus.hpp"
#include "drivers/simulation/simulated_motion.hpp"
#include "drivers/simulation/simulated_odrive.hpp"
#include "drivers/simulation/truth_socket.hpp"
#include "drivers/system/clock.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr Duration pass_period = std::chrono::milliseconds(2);
constexpr Duration truth_period = std::chrono::milliseconds(10);
/// After a longer pause of this process, simulated time continues without a jump.
constexpr Duration longest_pass = std::chrono::milliseconds(100);

constexpr std::array<std::pair<const char*, ScriptedFault>, 10> fault_names{{
    {"silent", ScriptedFault::silent},
    {"estop", ScriptedFault::emergency_stop},
    {"remote", ScriptedFault::remote},
    {"fault-bits", ScriptedFault::fault_bits},
    {"stuck-counter", ScriptedFault::stuck_counter},
    {"ignores", ScriptedFault::ignores},
    {"runaway", ScriptedFault::runaway},
    {"stuck-encoder", ScriptedFault::stuck_encoder},
    {"slip", ScriptedFault::slip},
    {"kidnap", ScriptedFault::kidnap},
}};

std::optional<SimulatedMotion::Surroundings> surroundings_of(const HostedBaseOptions& options) {
  if (!options.map) return std::nullopt;
  return SimulatedMotion::Surroundings{*options.map, options.robot_radius_m, options.robot_footprint};
}

const ProtocolTable& table_of(HostedProtocol protocol) {
  return protocol == HostedProtocol::odrive ? odrive::table : agilex::table;
}

std::vector<std::uint32_t> identifiers_of(HostedProtocol protocol) {
  const ProtocolTable& table = table_of(protocol);
  std::vector<std::uint32_t> all;
  if (protocol == HostedProtocol::odrive) all.push_back(odrive::address_of_all);
  for (std::uint32_t node = 0; node < static_cast<std::uint32_t>(table.nodes); ++node) {
    for (const MessageSpec& message : table.messages) all.push_back(message.id + node * table.node_step);
  }
  return all;
}

std::unique_ptr<SimulatedFirmware> make_firmware(CanBus& bus, SimulatedMotion& motion,
                                                 const HostedBaseOptions& options) {
  if (options.protocol == HostedProtocol::odrive)
    return std::make_unique<SimulatedOdrive>(bus, motion,
                                             SimulatedOdriveOptions{.watchdog = options.watchdog});
  SimulatedBaseOptions complete = options.base;
  complete.has_periphery = true;
  return std::make_unique<SimulatedBase>(bus, motion, complete);
}

void set_fault(SimulatedFirmware& base, SimulatedMotion& motion, std::uint64_t seed, ScriptedFault fault,
               bool on) {
  constexpr std::uint16_t motor_driver_fault = 0x0100;
  constexpr double slipping_share = 1.0 / 3.0;
  constexpr double carried_m = 1.0;
  switch (fault) {
    case ScriptedFault::emergency_stop:
      return base.press_emergency_stop(on);
    case ScriptedFault::remote:
      return base.take_over_by_remote(on);
    case ScriptedFault::fault_bits:
      return base.set_fault_bits(on ? motor_driver_fault : 0);
    case ScriptedFault::silent:
      base.defects().silent = on;
      return;
    case ScriptedFault::stuck_counter:
      base.defects().counter_stuck = on;
      return;
    case ScriptedFault::ignores:
      base.defects().ignores_commands = on;
      return;
    case ScriptedFault::runaway:
      base.defects().runs_away = on;
      return;
    case ScriptedFault::stuck_encoder:
      base.defects().left_encoder_stuck = on;
      return;
    case ScriptedFault::slip:
      return on ? motion.slip(slipping_share, slipping_share) : motion.slip(0.0, 0.0);
    case ScriptedFault::kidnap:
      if (on) motion.carry_off(carried_m, 0.0, Random(seed));
      return;
  }
}

}  // namespace

std::optional<ScriptedFault> fault_named(const std::string& name) {
  for (const auto& [known, fault] : fault_names) {
    if (name == known) return fault;
  }
  return std::nullopt;
}

std::string dbc_of(HostedProtocol protocol) {
  return dbc_text(table_of(protocol));
}

struct HostedBase::World {
  explicit World(const HostedBaseOptions& chosen)
      : options(chosen),
        bus(chosen.interface,
            {.identifiers = identifiers_of(chosen.protocol), .takes_remote_requests = true}),
        motion(chosen.base, chosen.start, chosen.seed, surroundings_of(chosen)),
        base(make_firmware(bus, motion, chosen)),
        truth(chosen.world.empty() ? chosen.interface : chosen.world),
        now(monotonic_now()),
        drive{.map_from_base = chosen.start} {
    const auto problem = problem_of(chosen.interface, look_at_can_interface(chosen.interface));
    if (!problem) return;
    throw InputError(fmt::format("--can: found that {}, wanted an interface that is up: {}", problem->found,
                                 problem->remedy));
  }

  void advance(Stamp until) {
    if (until - now > longest_pass) now = until - longest_pass;
    while (now + std::chrono::milliseconds(1) <= until) {
      now += std::chrono::milliseconds(1);
      motion.step(std::chrono::milliseconds(1));
      score();
    }
    base->step(now);
    if (!moved_first_at && base->is_told_to_move()) moved_first_at = now;
    switch_faults();
    if (now < next_truth) return;
    next_truth = now + truth_period;
    truth.tell({now, motion.true_map_from_base()});
  }

  void score() {
    const Pose2& at = motion.true_map_from_base();
    drive.driven_m += (at.position_m - drive.map_from_base.position_m).norm();
    drive.map_from_base = at;
    if (motion.is_blocked() && !was_blocked) ++drive.contacts;
    was_blocked = motion.is_blocked();
  }

  void switch_faults() {
    if (!moved_first_at) return;
    for (std::size_t i = 0; i < options.faults.size(); ++i) {
      const FaultSwitch& scripted = options.faults[i];
      const Duration since = now - *moved_first_at - scripted.at;
      const bool on = since >= Duration::zero() && !(scripted.lasting && since >= *scripted.lasting);
      if (is_on[i] != on) set_fault(*base, motion, options.seed, scripted.fault, on);
      is_on[i] = on;
    }
  }

  HostedBaseOptions options;
  SocketCanBus bus;
  SimulatedMotion motion;
  bool was_blocked = false;
  std::unique_ptr<SimulatedFirmware> base;
  TruthServer truth;
  Stamp now;
  Stamp next_truth;
  std::optional<Stamp> moved_first_at;
  std::vector<bool> is_on = std::vector<bool>(options.faults.size());
  HostedDrive drive;
};

HostedBase::HostedBase(const HostedBaseOptions& options) : world_(std::make_unique<World>(options)) {}

HostedBase::~HostedBase() = default;

HostedDrive HostedBase::run(const std::function<bool()>& stop) {
  Stamp next = monotonic_now();
  while (!stop()) {
    world_->advance(monotonic_now());
    next = std::max(next + pass_period, monotonic_now());
    sleep_until(next);
  }
  return world_->drive;
}

}  // namespace lodestar
