#include "maps/octree_file.hpp"

#include <fstream>

#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& found) {
  throw InputError(file, 0, found, "an OctoMap .bt or .ot file");
}

}  // namespace

/// The library prints most errors to the standard streams and returns null; a few it throws.
std::unique_ptr<octomap::OcTree> read_octree(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || is_folder(file)) refuse(file, "no file that can be read");
  std::string first_line;
  std::getline(stream, first_line);
  stream.seekg(0);
  std::unique_ptr<octomap::OcTree> tree;
  try {
    if (first_line.starts_with("# Octomap OcTree binary file")) {
      tree = std::make_unique<octomap::OcTree>(0.1);
      if (!tree->readBinary(stream)) tree.reset();
    } else if (first_line.starts_with("# Octomap OcTree file")) {
      std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(stream));
      if (dynamic_cast<octomap::OcTree*>(any.get()) != nullptr) {
        tree.reset(dynamic_cast<octomap::OcTree*>(any.release()));
      }
    } else {
      refuse(file, "another first line");
    }
  } catch (const std::bad_alloc&) {
    tree.reset();
  }
  if (!tree || tree->size() == 0) refuse(file, "a broken or empty tree");
  return tree;
}

}  // namespace lodestar
