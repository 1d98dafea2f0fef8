#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace lodestar {

/// A file in memory where the system supports it, for readers that take a path. One per process and name.
inline std::filesystem::path scratch_file(const std::string& name, const std::uint8_t* data,
                                          std::size_t size) {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path memory = "/dev/shm";
    const std::filesystem::path base =
        std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    const std::filesystem::path own = base / ("lodestar-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(own);
    return own;
  }();
  const std::filesystem::path file = folder / name;
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

}  // namespace lodestar
