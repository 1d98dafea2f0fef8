#include "maps/input_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

using ::testing::SizeIs;

std::string said_of(const std::string& found) {
  return InputError("a.yaml", 3, found, "a name").what();
}

TEST(InputError, says_where_what_was_found_and_what_was_wanted) {
  EXPECT_EQ(said_of("'Käse – 3 €'"), "a.yaml:3: found 'Käse – 3 €', wanted a name");
}

TEST(InputError, shortens_a_whole_file) {
  EXPECT_THAT(said_of(std::string(5000, 'x')), SizeIs(160 + said_of("...").size()));
  std::string euros;
  for (int i = 0; i < 100; ++i) euros += "€";
  EXPECT_EQ(said_of(euros).find("\\x"), std::string::npos) << "no character is cut";
}

TEST(InputError, shows_a_terminal_nothing_that_it_would_obey) {
  EXPECT_EQ(said_of("\x1B[2J\x07"), "a.yaml:3: found \\x1b[2J\\x07, wanted a name");
  EXPECT_EQ(said_of("a\xFF\xC3"), "a.yaml:3: found a\\xff\\xc3, wanted a name");
}

}  // namespace
}  // namespace lodestar
