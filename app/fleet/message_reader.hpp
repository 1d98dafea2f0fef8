#pragma once

#include <string>
#include <string_view>

#include "app/fleet/fleet_messages.hpp"

namespace lodestar {

struct MessageLimits {
  std::size_t bytes = 1'000'000;       ///< of a message; an order of 1000 nodes has about 200 KB
  std::size_t nodes = 1000;            ///< of an order
  std::size_t actions = 100;           ///< of a node, or of an instantActions message
  std::size_t parameters = 100;        ///< of an action
  std::size_t text_bytes = 256;        ///< of an ID or a name
  std::size_t parameter_bytes = 4096;  ///< of a parameter's value
};

/// Whom a message must be for, where it says so.
struct MessageAddress {
  std::string manufacturer;
  std::string serial;
};

/// Reads what masters send, leniently: the timestamp is not looked at, unknown fields are skipped, whole
/// numbers may be written as 2.0, and the names of older and of other versions are known (actionName,
/// allowedDeviationXy, instantActions for actions). Never throws: what cannot be read, is too large, or
/// contradicts itself is a validationError with references to the order, node, edge or action where they are
/// known.
FleetMessage read_order(std::string_view text, const MessageAddress& address = {},
                        const MessageLimits& limits = {});
FleetMessage read_instant_actions(std::string_view text, const MessageAddress& address = {},
                                  const MessageLimits& limits = {});

}  // namespace lodestar
