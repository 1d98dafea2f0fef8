#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lodestar {

/// All that is in a file, byte by byte; nothing where it is a folder, or cannot be read.
std::optional<std::string> file_text(const std::filesystem::path& file);

/// The same of one that must be there: otherwise throws InputError with what is wanted.
std::string file_text(const std::filesystem::path& file, const std::string& wanted);

}  // namespace lodestar
