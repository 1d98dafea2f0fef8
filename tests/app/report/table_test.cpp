#include "app/report/table.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

const Table small{"Sizes", {"", "mm"}, {{"dot", "20"}, {"a<b", "140"}}};

TEST(Table, stands_in_columns) {
  EXPECT_EQ(text_of(small), "Sizes\n        mm\n  dot   20\n  a<b  140\n");
}

TEST(Table, is_escaped_in_a_page) {
  const std::string html = html_of(small);
  EXPECT_NE(html.find("<td>a&lt;b</td><td>140</td>"), std::string::npos);
  EXPECT_NE(html.find("<h2>Sizes</h2>"), std::string::npos);
}

}  // namespace
}  // namespace lodestar
