#pragma once

#include <memory>
#include <string>

#include "app/site/site.hpp"
#include "drivers/base/base_driver.hpp"
#include "drivers/base/base_protocol.hpp"

namespace lodestar {

/// The connection to the site's base, over `interface` unless that is empty. Throws InputError when neither
/// is given.
BaseConnection connection_of(const Site& site, const std::string& interface);

/// The protocol driver of that base. Throws InputError when robot.yaml names faults or modes that this base
/// does not have.
std::unique_ptr<BaseProtocol> make_protocol(const BaseConnection& connection, const Robot& robot);

/// The limits of robot.yaml.
BaseDriverOptions base_driver_options(const Robot& robot);
/// These, and the reported faults that do not stop the robot. Throws InputError as make_protocol() does.
BaseDriverOptions base_driver_options(const Robot& robot, const BaseProtocol& protocol);

}  // namespace lodestar
