#include "app/common/json_parse.hpp"

#include <gmock/gmock.h>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string nested(std::size_t levels) {
  return std::string(levels, '[') + std::string(levels, ']');
}

TEST(ParseJson, ReadsWhatIsNestedAsDeepAsItMayBe) {
  EXPECT_TRUE(parse_json(nested(32)).is_array());
  EXPECT_EQ(parse_json(R"({"a": [1, {"b": 2}], "c": "[[[["})")["a"][1]["b"], 2);
}

TEST(ParseJson, RefusesWhatIsNestedDeeper) {
  EXPECT_THAT([] { parse_json(nested(33)); }, ThrowsMessage<InputError>(HasSubstr("nested deeper than 32")));
  EXPECT_THAT([] { parse_json(nested(200'000)); }, ThrowsMessage<InputError>(HasSubstr("nested deeper")));
  EXPECT_THAT([] { parse_json(R"({"a\"":)" + nested(40) + "}"); },
              ThrowsMessage<InputError>(HasSubstr("deeper")));
}

TEST(ParseJson, DoesNotCountWhatIsClosedOrQuoted) {
  std::string many = "[";
  for (int i = 0; i < 1000; ++i) many += R"([{"k]": "\"[[{"}],)";
  EXPECT_EQ(parse_json(many + "0]").size(), 1001U);
}

TEST(ParseJson, RefusesWhatIsNone) {
  for (const char* text : {"", "{", "[1,]", "nan", "]", "\"\\"}) {
    EXPECT_THAT([&] { parse_json(text); }, ThrowsMessage<InputError>(HasSubstr("found no JSON"))) << text;
  }
}

}  // namespace
}  // namespace lodestar
