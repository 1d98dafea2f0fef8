#pragma once

#include <string>
#include <string_view>

namespace lodestar {

/// The JSON Schema of a message: those of Foxglove that we send ("foxglove.Grid"), known to its viewers by
/// name, and our own ("lodestar.Drive"). Throws std::out_of_range for an unknown name.
std::string viewer_schema(std::string_view name);

}  // namespace lodestar
