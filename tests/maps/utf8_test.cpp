#include "maps/utf8.hpp"

#include <gtest/gtest.h>

#include "maps/strict_yaml.hpp"

#include "tests/maps/spoilt_file.hpp"

namespace lodestar {
namespace {

TEST(Utf8, tells_characters_by_their_first_byte) {
  EXPECT_EQ(utf8_character_bytes("a"), 1U);
  EXPECT_EQ(utf8_character_bytes("ü"), 2U);
  EXPECT_EQ(utf8_character_bytes("€ or $"), 3U);
  EXPECT_EQ(utf8_character_bytes("\xF0\x9F\xA4\x96"), 4U);
  EXPECT_EQ(utf8_character_bytes(""), 0U);
  EXPECT_TRUE(is_utf8("Büro 3 – 5 €"));
  EXPECT_TRUE(is_utf8(""));
}

TEST(Utf8, is_none_of_what_rfc_3629_excludes) {
  for (const char* text : {"B\xFCro",           // Latin-1
                           "a\xC3",             // cut short
                           "\x80",              // no first byte
                           "\xC0\x80",          // overlong
                           "\xE0\x9F\xBF",      // overlong
                           "\xF0\x8F\xBF\xBF",  // overlong
                           "\xED\xA0\x80",      // a surrogate
                           "\xF4\x90\x80\x80",  // beyond the last character
                           "\xFF"})
    EXPECT_FALSE(is_utf8(text)) << text;
}

/// A file in Latin-1, as old editors write it, is told so before a drive, not by what writes the results.
TEST(Utf8, is_what_names_in_yaml_must_be) {
  const auto load = [](const std::filesystem::path& file) {
    StrictYaml yaml = StrictYaml::load(file);
    return yaml.text("name");
  };
  EXPECT_NE(error_of("site.yaml", "version: 1\nname: B\xFCro\n", load)
                .find("site.yaml:2: found 'B\\xfcro', wanted text in UTF-8 for 'name'"),
            std::string::npos);
  EXPECT_NE(error_of("site.yaml", "name: a\nB\xFCro: b\n", load)
                .find("site.yaml:2: found the key 'B\\xfcro', wanted text in UTF-8"),
            std::string::npos);
  EXPECT_EQ(error_of("site.yaml", "name: Büro  # f\xFCr alle\n", load), "no error") << "a comment may be";
}

}  // namespace
}  // namespace lodestar
