#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/simulation/scoring.hpp"
#include "drivers/simulation/simulated_base.hpp"
#include "maps/footprint.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// Faults that can be injected into the simulated base and its world while it drives.
enum class ScriptedFault {
  silent,  ///< no feedback: the cable is cut behind the controller
  emergency_stop,
  remote,         ///< the remote control takes over
  fault_bits,     ///< the motor driver reports a fault
  stuck_counter,  ///< the firmware repeats its counter
  ignores,        ///< stands, whatever is commanded
  runaway,        ///< drives on, whatever is commanded
  stuck_encoder,  ///< the left wheel turns, its odometer does not count
  slip,           ///< the robot moves a third less than the wheels roll
  kidnap          ///< the robot is displaced by 1 m at once
};

/// "silent", "estop", "remote", "fault-bits", "stuck-counter", "ignores", "runaway", "stuck-encoder", "slip",
/// "kidnap".
std::optional<ScriptedFault> fault_named(const std::string& name);

struct FaultSwitch {
  ScriptedFault fault = ScriptedFault::silent;
  Duration at{};                    ///< after the first command that moves the base
  std::optional<Duration> lasting;  ///< empty: for ever
};

enum class HostedProtocol { agilex, odrive };

struct HostedBaseOptions {
  std::string interface;
  std::string world;  ///< the interface under which the simulated camera finds it, if another one
  HostedProtocol protocol = HostedProtocol::agilex;
  SimulatedBaseOptions base;
  Pose2 start;
  std::optional<OccupancyMap> map;  ///< empty: an endless empty floor
  double robot_radius_m = 0.25;
  std::optional<Footprint> robot_footprint;  ///< collides in place of the disc
  std::uint64_t seed = 1;
  std::vector<FaultSwitch> faults;
  std::optional<Duration> watchdog;  ///< of an ODrive's axes; empty: switched off, as by default
};

/// The protocol as the text of a .dbc file.
std::string dbc_of(HostedProtocol protocol);

/// The true outcome of a hosted base's drive.
struct HostedDrive {
  Pose2 map_from_base;  ///< at the end
  double driven_m = 0.0;
  int contacts = 0;  ///< with the map, one from touch to release
};

/// The simulated base and its world, on a real CAN interface in real time. Clients see its frames as those of
/// a real base; the simulated camera receives the true pose over a socket.
class HostedBase {
 public:
  /// Throws InputError when the interface is missing, switched off, or simulates a base already.
  explicit HostedBase(const HostedBaseOptions& options);
  ~HostedBase();

  /// Runs until `stop` returns true; it is called every few milliseconds.
  HostedDrive run(const std::function<bool()>& stop);

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace lodestar
