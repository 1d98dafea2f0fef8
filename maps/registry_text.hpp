#pragma once

#include <filesystem>
#include <string>

#include "maps/marker_registry.hpp"

namespace lodestar {

/// What load_registry does, for a text; `file` is only named in complaints.
MarkerRegistry parse_registry(const std::string& text, const std::filesystem::path& file);

/// What save_registry writes: one marker a line.
std::string registry_text(const MarkerRegistry& registry);

}  // namespace lodestar
