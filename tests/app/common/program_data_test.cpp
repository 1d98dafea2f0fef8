#include "app/common/program_data.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// A folder with one file, `name`.
fs::path make_file(const TemporaryFolder& root, const std::string& name) {
  const fs::path file = root / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "format: lodestar-site\n";
  return file;
}

TEST(ProgramData, of_an_installed_program_is_in_share_of_its_prefix) {
  const TemporaryFolder root;
  make_file(root, "usr/share/lodestar/sites/lab/site.yaml");
  EXPECT_EQ(data_beside(root / "usr/bin", "sites/lab"), root / "usr/share/lodestar/sites/lab");
  EXPECT_EQ(data_beside(root / "usr/bin", "sites/hall"), std::nullopt);
}

TEST(ProgramData, of_a_build_tree_is_below_the_program) {
  const TemporaryFolder root;
  make_file(root, "build/share/lodestar/faults/wheel-slip.yaml");
  EXPECT_EQ(data_beside(root / "build", "faults"), root / "build/share/lodestar/faults");
}

TEST(ProgramData, of_this_build_is_found_from_any_folder) {
  const fs::path before = fs::current_path();
  fs::current_path("/");
  const fs::path lab = program_data("sites/lab");
  const fs::path nowhere = program_data("sites/nowhere");
  fs::current_path(before);
  EXPECT_TRUE(fs::equivalent(lab, fs::path(LODESTAR_SOURCE_DIR) / "sites/lab")) << lab;
  EXPECT_EQ(nowhere, "sites/nowhere");
}

/// Folders for one case; the tests run as root too, whom no permission stops: what cannot be written is a
/// file.
class RunsFolder : public testing::Test {
 protected:
  RunsFolder() { make_file(root_, "file"); }

  TemporaryFolder root_;
  WritableFolders folders_{.working_directory = root_.path() / "file",
                           .state_home = root_.path() / "state",
                           .home = root_.path() / "home",
                           .temporary = root_.path()};
};

TEST_F(RunsFolder, is_in_the_working_directory_where_that_may_be_written) {
  folders_.working_directory = root_.path();
  EXPECT_EQ(runs_folder(folders_), root_.path() / "runs");
}

TEST_F(RunsFolder, is_else_in_the_users_state_folder) {
  EXPECT_EQ(runs_folder(folders_), root_.path() / "state/lodestar/runs");
  folders_.state_home.clear();
  fs::create_directory(folders_.home);
  EXPECT_EQ(runs_folder(folders_), root_.path() / "home/.local/state/lodestar/runs");
  EXPECT_TRUE(fs::is_directory(root_.path() / "home/.local/state/lodestar/runs"));
}

TEST_F(RunsFolder, of_a_user_without_home_is_a_private_one_in_the_temporary_folder) {
  folders_.state_home.clear();
  const fs::path own = root_.path() / ("lodestar-" + std::to_string(::geteuid()));
  EXPECT_EQ(runs_folder(folders_), own / "runs");
  EXPECT_EQ(fs::status(own).permissions(), fs::perms::owner_all);
}

TEST_F(RunsFolder, is_nowhere_that_a_link_of_somebody_else_leads_to) {
  folders_.state_home.clear();
  fs::create_directory(root_ / "elsewhere");
  fs::create_symlink(root_ / "elsewhere", root_ / ("lodestar-" + std::to_string(::geteuid())));
  EXPECT_THROW((void)runs_folder(folders_), InputError);
}

}  // namespace
}  // namespace lodestar
