#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "maps/stamp.hpp"

// What viewers receive, from a file or live: channels of JSON messages, each with a schema.
namespace lodestar {

struct Channel {
  std::string topic;
  std::string schema_name;
  std::string schema;          ///< JSON Schema
  bool every_message = false;  ///< events: every one is delivered, not only the newest
};

struct Message {
  std::size_t channel = 0;  ///< index in the list of channels
  Stamp stamp;
  std::string json;
};

}  // namespace lodestar
