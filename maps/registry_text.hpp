#pragma once

#include <filesystem>
#include <string>

#include "maps/marker_registry.hpp"

namespace lodestar {

/// load_registry for a text; `file` is only named in error messages.
MarkerRegistry parse_registry(const std::string& text, const std::filesystem::path& file);

/// The text that save_registry writes: one marker per line.
std::string registry_text(const MarkerRegistry& registry);

}  // namespace lodestar
