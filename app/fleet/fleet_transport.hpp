#pragma once

#include <functional>
#include <string>
#include <thread>

#include "app/common/log.hpp"
#include "app/fleet/fleet_link.hpp"
#include "app/fleet/message_writer.hpp"
#include "app/site/fleet_settings.hpp"

namespace lodestar {

/// Speaks MQTT with the broker, on a thread of its own: sends what the control loop reports, and reads what
/// comes for it. While there is no broker it tries again, at first after half a second and then every five;
/// the robot's client ID is always the same, so that a broker ends the old connection before it begins the
/// new one.
class FleetTransport {
 public:
  /// Throws InputError when a file of the settings cannot be used.
  FleetTransport(const FleetSettings& settings, const Factsheet& factsheet, FleetLink& link,
                 std::function<void(Severity, const std::string&)> tell);
  /// Says OFFLINE where there is a connection, and ends.
  ~FleetTransport();
  FleetTransport(const FleetTransport&) = delete;
  FleetTransport& operator=(const FleetTransport&) = delete;

 private:
  class Client;
  std::unique_ptr<Client> client_;
  std::jthread thread_;  ///< the last member: it uses the others
};

}  // namespace lodestar
