#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <set>

#include "tests/architecture/arrows.hpp"

// The limit on the length of source files holds for tests too.
namespace lodestar {
namespace {

namespace fs = std::filesystem;

std::ptrdiff_t lines_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return std::count(std::istreambuf_iterator<char>(stream), {}, '\n');
}

TEST(TestFiles, StayShort) {
  const std::set<fs::path> written{".cpp", ".hpp", ".py"};
  int seen = 0;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(fs::path(LODESTAR_SOURCE_DIR) / "tests")) {
    if (!entry.is_regular_file() || !written.contains(entry.path().extension())) continue;
    EXPECT_LE(lines_of(entry.path()), longest_source_lines) << entry.path();
    ++seen;
  }
  EXPECT_GT(seen, 100) << "no test files where they are looked for";
}

}  // namespace
}  // namespace lodestar
