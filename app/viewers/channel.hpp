#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "maps/stamp.hpp"

// What viewers receive, from a file or live: channels of messages, each with a schema.
namespace lodestar {

struct Channel {
  std::string topic;
  std::string schema_name;
  std::string schema;
  bool every_message = false;  ///< events: every one is delivered, not only the newest
  bool is_live = true;         ///< else only in files
  std::string schema_encoding = "jsonschema";
  std::string encoding = "json";  ///< of the messages
};

struct Message {
  std::size_t channel = 0;  ///< index in the list of channels
  Stamp stamp;
  std::string content;  ///< in the channel's encoding
};

}  // namespace lodestar
