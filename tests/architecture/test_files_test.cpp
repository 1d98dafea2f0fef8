#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <set>
#include <string>

#include "tests/architecture/arrows.hpp"

// The limit on the length of source files holds for tests too, and tests that run at once share no file.
namespace lodestar {
namespace {

namespace fs = std::filesystem;

std::ptrdiff_t lines_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return std::count(std::istreambuf_iterator<char>(stream), {}, '\n');
}

/// Calls `look` with each source file of the tests.
template <typename Look>
int for_each_test_file(Look look) {
  const std::set<fs::path> written{".cpp", ".hpp", ".py"};
  int seen = 0;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(fs::path(LODESTAR_SOURCE_DIR) / "tests")) {
    if (!entry.is_regular_file() || !written.contains(entry.path().extension())) continue;
    look(entry.path());
    ++seen;
  }
  return seen;
}

TEST(TestFiles, StayShort) {
  const int seen = for_each_test_file(
      [](const fs::path& file) { EXPECT_LE(lines_of(file), longest_source_lines) << file; });
  EXPECT_GT(seen, 100) << "no test files where they are looked for";
}

/// ctest runs the tests of one program side by side: a name in the common folder is another test's, too.
TEST(TestFiles, WriteInFoldersOfTheirOwn) {
  const std::string common_folder = std::string("TempDir") + "()";
  for_each_test_file([&](const fs::path& file) {
    std::ifstream stream(file);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(text.find(common_folder), std::string::npos) << file << ": wanted TemporaryFolder";
  });
}

}  // namespace
}  // namespace lodestar
