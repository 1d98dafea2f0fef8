#include "maps/file_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>

#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

std::string refusal_of(const std::filesystem::path& file) {
  try {
    file_text(file, "a YAML file");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FileText, is_every_byte_of_the_file) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff\n", 7);
  const std::filesystem::path file = folder.write("some.bin", bytes);
  EXPECT_EQ(file_text(file), bytes);
  EXPECT_EQ(file_text(file, "bytes"), bytes);
  EXPECT_EQ(file_text(folder.write("empty", "")), "");
}

/// Of those the size is not known before they are read.
TEST(FileText, is_that_of_files_of_the_kernel_too) {
  EXPECT_THAT(file_text("/proc/self/status").value_or(""), HasSubstr("Pid:"));
}

TEST(FileText, is_nothing_of_a_folder_and_of_what_is_not_there) {
  const TemporaryFolder folder;
  EXPECT_FALSE(file_text(folder / "none"));
  EXPECT_FALSE(file_text(folder / ""));
  EXPECT_THAT(refusal_of(folder / "none"), HasSubstr("found no file that can be read, wanted a YAML file"));
  EXPECT_THAT(refusal_of(folder / ""), HasSubstr("found a folder, wanted a YAML file"));
}

}  // namespace
}  // namespace lodestar
