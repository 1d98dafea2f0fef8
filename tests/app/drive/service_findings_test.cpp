#include "app/drive/service_findings.hpp"

#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <unistd.h>

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// A tree like that of a machine with the package, one site, and a service that runs.
class ServiceFindings : public testing::Test {
 protected:
  ServiceFindings() {
    fs::create_directories(root_ / "run/systemd/system");
    make("usr/lib/systemd/system/lodestar@.service", "[Service]\n");
    make("etc/passwd",
         fmt::format("root:x:0:0::/root:/bin/sh\nlodestar:x:{}:120::/var/lib/lodestar:\n", ::geteuid()));
    make("etc/lodestar/hall/site.yaml", "");
    fs::create_directories(root_ / "var/lib/lodestar/hall");
    make("etc/systemd/network/80-can0.network", "[Match]\nName=can0\n\n[CAN]\nBitRate=500K\n");
    make(group_ + "/cgroup.procs", "4711\n");
    fs::create_directories(root_ / "etc/systemd/system/multi-user.target.wants");
    fs::create_symlink("/usr/lib/systemd/system/lodestar@.service", root_ / wanted_);
  }

  void make(const std::string& name, const std::string& text) {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }

  [[nodiscard]] std::vector<Finding> look() const { return look_at_service(site_, {.root = root_.path()}); }

  [[nodiscard]] Finding finding(const std::string& what) const {
    for (const Finding& each : look())
      if (each.what == what) return each;
    return {.what = "none", .found = "no finding of " + what};
  }

  TemporaryFolder root_;
  std::string group_ = "sys/fs/cgroup/system.slice/system-lodestar.slice/lodestar@hall.service";
  std::string wanted_ = "etc/systemd/system/multi-user.target.wants/lodestar@hall.service";
  ServiceSite site_{.name = "hall", .folder = root_ / "etc/lodestar/hall", .interface = "can0"};
};

TEST_F(ServiceFindings, are_good_where_all_is_set_up) {
  EXPECT_EQ(look().size(), 4U);
  for (const Finding& each : look())
    EXPECT_EQ(each.verdict, Verdict::good) << each.what << ": " << each.found;
  EXPECT_THAT(fix_script(look()), IsEmpty());
}

TEST_F(ServiceFindings, are_none_without_systemd) {
  fs::remove_all(root_ / "run");
  EXPECT_THAT(look(), IsEmpty());
}

TEST_F(ServiceFindings, name_a_package_that_is_not_installed) {
  fs::remove(root_ / "usr/lib/systemd/system/lodestar@.service");
  EXPECT_THAT(finding("service").found, HasSubstr("not installed"));
  EXPECT_EQ(look().size(), 2U);
}

TEST_F(ServiceFindings, tell_a_service_that_does_not_run_from_one_that_does_not_start_at_boot) {
  fs::remove_all(root_ / group_);
  EXPECT_EQ(finding("service").found, "lodestar@hall does not run, and starts at boot");
  fs::remove(root_ / wanted_);
  EXPECT_EQ(finding("service").commands, "sudo systemctl enable --now lodestar@hall\n");
}

TEST_F(ServiceFindings, have_the_commands_that_put_a_site_where_the_service_looks) {
  site_.folder = "/home/me/hall";
  const Finding folder = finding("site folder");
  EXPECT_EQ(folder.verdict, Verdict::doubtful);
  EXPECT_THAT(folder.commands,
              AllOf(HasSubstr("cp -r '/home/me/hall' '"), HasSubstr("chown -R lodestar:lodestar")));
}

TEST_F(ServiceFindings, are_bad_when_the_service_cannot_write_what_it_learns) {
  make("etc/passwd", fmt::format("lodestar:x:{}:120::/var/lib/lodestar:\n", ::geteuid() + 1));
  EXPECT_EQ(finding("state").verdict, Verdict::bad);
  EXPECT_THAT(finding("state").commands, HasSubstr("var/lib/lodestar/hall"));
  EXPECT_THAT(finding("site folder").found, HasSubstr("the console cannot save"));
}

TEST_F(ServiceFindings, have_a_file_for_an_interface_that_nobody_brings_up) {
  site_.interface = "can1";
  const std::string script = fix_script(look());
  EXPECT_THAT(script, HasSubstr("# CAN at boot: can1 is in no file of systemd-networkd\n"
                                "sudo tee /etc/systemd/network/80-can1.network <<'END'\n"
                                "[Match]\nName=can1\n\n[CAN]\nBitRate=500000\n"));
  site_.is_virtual_interface = true;
  EXPECT_THAT(fix_script(look()), IsEmpty());
}

}  // namespace
}  // namespace lodestar
