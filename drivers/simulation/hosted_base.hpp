#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/simulation/scoring.hpp"
#include "drivers/simulation/simulated_base.hpp"
#include "maps/occupancy_map.hpp"

namespace lodestar {

/// What can be made to happen to the simulated base, and to the world around it, while it drives.
enum class ScriptedFault {
  silent,  ///< no feedback any more: the cable is cut behind the controller
  emergency_stop,
  remote,         ///< the remote control takes over
  fault_bits,     ///< the motor driver reports a fault
  stuck_counter,  ///< the firmware repeats itself
  ignores,        ///< stands, whatever it is told
  runaway,        ///< drives on, whatever it is told
  stuck_encoder,  ///< the left wheel turns, its odometer does not
  slip,           ///< the wheels turn, of the floor a third less goes by
  kidnap          ///< somebody carries it 1 m away, at once
};

/// "silent", "estop", "remote", "fault-bits", "stuck-counter", "ignores", "runaway", "stuck-encoder", "slip",
/// "kidnap".
std::optional<ScriptedFault> fault_named(const std::string& name);

struct FaultSwitch {
  ScriptedFault fault = ScriptedFault::silent;
  Duration at{};                    ///< after the first command that moves the base
  std::optional<Duration> lasting;  ///< for ever, when left out
};

enum class HostedProtocol { agilex, odrive };

struct HostedBaseOptions {
  std::string interface;
  std::string world;  ///< the interface by which the simulated camera finds it, when that is another one
  HostedProtocol protocol = HostedProtocol::agilex;
  SimulatedBaseOptions base;
  Pose2 start;
  std::optional<OccupancyMap> map;  ///< an endless empty floor, when left out
  double robot_radius_m = 0.25;
  std::uint64_t seed = 1;
  std::vector<FaultSwitch> faults;
};

/// The protocol as the text of a .dbc file.
std::string dbc_of(HostedProtocol protocol);

/// How the drive of a hosted base truly was.
struct HostedDrive {
  Pose2 map_from_base;  ///< at the end
  double driven_m = 0.0;
  int contacts = 0;
};

/// The simulated base, and the world that it moves in, on a real CAN interface in real time. Clients find it
/// by its frames as they would find a real one; the simulated camera hears the true pose over a socket.
class HostedBase {
 public:
  /// Throws InputError when the interface cannot be used.
  explicit HostedBase(const HostedBaseOptions& options);
  ~HostedBase();

  /// Lives until `stop` says so; asked every few milliseconds.
  HostedDrive run(const std::function<bool()>& stop);

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace lodestar
