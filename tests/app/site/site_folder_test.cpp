#include "app/site/site_folder.hpp"

#include <gmock/gmock.h>

#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

const fs::path lab = fs::path(LODESTAR_SOURCE_DIR) / "sites/lab";

TEST(SiteFolder, of_a_name_is_the_example_of_that_name) {
  EXPECT_TRUE(fs::equivalent(site_folder("lab"), lab));
  EXPECT_TRUE(fs::equivalent(site_folder(""), lab));
}

TEST(SiteFolder, is_the_folder_that_is_given_where_there_is_one) {
  const TemporaryFolder root;
  const fs::path before = fs::current_path();
  fs::create_directory(root / "lab");
  fs::current_path(root.path());
  const fs::path found = site_folder("lab");
  fs::current_path(before);
  EXPECT_EQ(found, "lab");
}

TEST(SiteFolder, that_is_not_there_stays_as_given_and_is_named_in_the_error) {
  EXPECT_EQ(site_folder("./lab"), "./lab");
  EXPECT_EQ(site_folder("no-such-site"), "no-such-site");
  EXPECT_THROW((void)open_site("no-such-site"), InputError);
}

}  // namespace
}  // namespace lodestar
