#include "tests/architecture/method_page.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <sstream>

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const fs::path root = LODESTAR_SOURCE_DIR;

std::string page() {
  std::ostringstream text;
  text << std::ifstream(root / "docs/method.md", std::ios::binary).rdbuf();
  return text.str();
}

/// A folder with one source file, and the complaints about a row with this cell for the code.
class RottenPage : public testing::Test {
 protected:
  RottenPage() {
    fs::create_directories(folder_ / "maps");
    std::ofstream(folder_ / "maps/home.hpp") << "/// Eq. (1)\nint optimal_marker();\n";
  }

  [[nodiscard]] std::vector<std::string> complaints(int equation, const std::string& in_the_code) const {
    return complaints_about_row({equation, in_the_code, in_the_code}, folder_.path());
  }

  TemporaryFolder folder_;
};

TEST(MethodPage, HasARowForEachEquationInOrder) {
  int wanted = 1;
  for (const MethodRow& row : method_rows(page())) EXPECT_EQ(row.equation, wanted++);
  EXPECT_EQ(wanted, 20);
}

TEST(MethodPage, NamesFilesAndSymbolsThatAreThere) {
  for (const MethodRow& row : method_rows(page())) {
    EXPECT_THAT(complaints_about_row(row, root), IsEmpty()) << "Eq. (" << row.equation << ")";
  }
}

TEST(MethodPage, LinksToPagesThatAreThere) {
  const std::vector<std::string> links = links_in(page());
  EXPECT_THAT(links, Contains("decisions/0001-map-estimate-over-p3p.md"));
  for (const std::string& link : links) EXPECT_TRUE(fs::is_regular_file(root / "docs" / link)) << link;
}

TEST_F(RottenPage, IsComplainedAbout) {
  EXPECT_THAT(complaints(1, "`maps/home.hpp` `optimal_marker`"), IsEmpty());
  EXPECT_THAT(complaints(1, "`maps/home.hpp` `optimal`"), ElementsAre("optimal is not in maps/home.hpp"));
  EXPECT_THAT(complaints(1, "`maps/home.hpp`"), ElementsAre("(1) has no symbol"));
  EXPECT_THAT(complaints(1, "`maps/gone.hpp` `optimal_marker`"), Contains("maps/gone.hpp is not there"));
  EXPECT_THAT(complaints(1, "`optimal_marker`"), Contains("optimal_marker is named without a file"));
  EXPECT_THAT(complaints(2, "`maps/home.hpp` `optimal_marker`"),
              ElementsAre("(2) is named in none of its files"));
}

TEST(MethodPage, FindsEquationsInComments) {
  EXPECT_THAT(equations_named_in("/// Eq. (2) and (4)-(6), as in (9)\n f(7);  // (8)\n"),
              ElementsAre(2, 4, 5, 6, 8));
  EXPECT_THAT(equations_named_in("at(3) f(5)"), SizeIs(0));
}

}  // namespace
}  // namespace lodestar
