#pragma once

#include <filesystem>
#include <memory>
#include <octomap/OcTree.h>

// For the units that take OctoMaps apart; all others ask them.
namespace lodestar {

/// Reads an OctoMap .bt or .ot file. Throws InputError.
std::unique_ptr<octomap::OcTree> read_octree(const std::filesystem::path& file);

}  // namespace lodestar
