#pragma once

#include <filesystem>

namespace lodestar {

/// The folder of the lab site, from any working directory.
std::filesystem::path lab_site();

}  // namespace lodestar
