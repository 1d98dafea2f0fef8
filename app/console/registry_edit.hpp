#pragma once

#include <string>

#include "maps/marker_registry.hpp"

namespace lodestar {

/// The text of a registry file after an edit: a line whose marker has not moved, and every comment, stays as
/// it is byte for byte, so that a diff shows what moved and nothing else. `before` is the registry read from
/// `text`. Unless each marker has a line of its own, the whole file is rewritten.
/// A marker keeps the sigmas of its survey unless it has moved.
std::string edited_registry_text(const std::string& text, const MarkerRegistry& before,
                                 const MarkerRegistry& edited_registry);

}  // namespace lodestar
