#include "maps/atomic_file.hpp"

#include <array>
#include <fcntl.h>
#include <fstream>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  static std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const fs::path folder = fs::temp_directory_path() / ("lodestar-atomic-" + std::to_string(::getpid()));
};

TEST_F(AtomicFile, behind_a_symbolic_link_is_replaced_and_the_link_stays) {
  std::ofstream(folder / "target") << "old";
  fs::create_symlink(folder / "target", folder / "link");
  write_file_atomically(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(content(folder / "target"), "new");
}

TEST_F(AtomicFile, does_not_replace_a_pipe_but_writes_into_it) {
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  write_file_atomically(pipe, "words");
  std::array<char, 16> read{};
  EXPECT_EQ(::read(reader, read.data(), read.size()), 5);
  EXPECT_STREQ(read.data(), "words");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(AtomicFile, leaves_a_folder_where_it_is) {
  fs::create_directories(folder / "inner");
  EXPECT_THROW(write_file_atomically(folder / "inner", "words"), InputError);
  EXPECT_TRUE(fs::is_directory(folder / "inner"));
}

}  // namespace
}  // namespace lodestar
