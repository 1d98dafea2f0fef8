#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "maps/stamp.hpp"

// What a viewer is shown, whether it reads a file or listens: channels of JSON messages with a schema each.
namespace lodestar {

struct Channel {
  std::string topic;
  std::string schema_name;
  std::string schema;          ///< JSON Schema
  bool every_message = false;  ///< not only the newest counts: they are events
};

struct Message {
  std::size_t channel = 0;  ///< its place in the list of channels
  Stamp stamp;
  std::string json;
};

}  // namespace lodestar
