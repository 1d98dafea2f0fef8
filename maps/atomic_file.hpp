#pragma once

#include <filesystem>
#include <string_view>

namespace lodestar {

/// Replaces a file's content in one step (temporary file beside it, fsync, rename, fsync of the folder): a
/// reader sees either the complete old content or the complete new content. Throws InputError when the folder
/// cannot be written.
void write_file_atomically(const std::filesystem::path& file, std::string_view content);

}  // namespace lodestar
