#pragma once

#include <memory>
#include <string>

#include "app/site/site.hpp"
#include "drivers/base/base_protocol.hpp"

namespace lodestar {

/// The connection to the site's base, over `interface` unless that is empty. Throws InputError when neither
/// is given.
BaseConnection connection_of(const Site& site, const std::string& interface);

/// The protocol driver of that base.
std::unique_ptr<BaseProtocol> make_protocol(const BaseConnection& connection, const Robot& robot);

}  // namespace lodestar
