#pragma once

#include <filesystem>
#include <memory>
#include <octomap/OcTree.h>

// For the sources that read octrees directly; all others use Octomap, SightLines or HeightBands.
namespace lodestar {

/// Reads an OctoMap .bt or .ot file. Throws InputError.
std::unique_ptr<octomap::OcTree> read_octree(const std::filesystem::path& file);

}  // namespace lodestar
