#pragma once

#include <filesystem>
#include <string_view>

namespace lodestar {

/// Replaces a file's content in one step (temporary file beside it, fsync, rename, fsync of the folder): a
/// reader sees either the complete old content or the complete new content. Throws InputError when the folder
/// cannot be written. A symbolic link stays, and what it leads to is replaced; a device or pipe is written
/// to.
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace lodestar
