#include "tests/can/xstate.hpp"

#include <cerrno>
#include <csignal>
#include <dlfcn.h>
#include <elf.h>
#include <gmock/gmock.h>
#include <sys/ptrace.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace lodestar::xstate {
namespace {

constexpr std::size_t uml_size = 2696;
constexpr std::size_t amx_size = 11008;

std::vector<std::byte> area_full_of(int value, std::size_t size, std::uint64_t parts) {
  std::vector<std::byte> area(size, std::byte(value));
  set_parts_in_use(area, parts);
  return area;
}

class Beginning : public testing::TestWithParam<std::size_t> {};

TEST_P(Beginning, IsLaidOverTheWholeAndTheRestStays) {
  const std::vector<std::byte> beginning = area_full_of(1, GetParam(), 0x2E7);
  const std::vector<std::byte> before = area_full_of(2, amx_size, 0x7);
  std::vector<std::byte> whole = before;

  ASSERT_TRUE(lay_over(whole, beginning));

  std::vector<std::byte> expected = beginning;
  expected.insert(expected.end(), before.begin() + static_cast<std::ptrdiff_t>(GetParam()), before.end());
  EXPECT_EQ(whole, expected);
}

TEST_P(Beginning, LeavesNoAmxInUse) {
  const std::vector<std::byte> beginning = area_full_of(0, GetParam(), amx_parts | 0x2E7);
  std::vector<std::byte> whole = area_full_of(0, amx_size, amx_parts | 0x7);

  ASSERT_TRUE(lay_over(whole, beginning));

  EXPECT_EQ(parts_in_use(whole), 0x2E7U);
}

INSTANTIATE_TEST_SUITE_P(OfSize, Beginning, testing::Values(576, 832, uml_size, 11000, amx_size));

TEST(Beginning, WithoutAllOfTheHeaderIsRefused) {
  const std::vector<std::byte> before = area_full_of(2, amx_size, amx_parts);
  for (const std::size_t size : {std::size_t{0}, header_begin, header_end - 1}) {
    std::vector<std::byte> whole = before;
    EXPECT_FALSE(lay_over(whole, std::vector<std::byte>(size))) << size;
    EXPECT_EQ(whole, before) << size;
  }
}

TEST(Beginning, LargerThanTheWholeIsRefused) {
  for (const std::size_t size : {std::size_t{832}, uml_size - 1}) {
    const std::vector<std::byte> before = area_full_of(2, size, 0x7);
    std::vector<std::byte> whole = before;
    EXPECT_FALSE(lay_over(whole, area_full_of(1, uml_size, 0x7))) << size;
    EXPECT_EQ(whole, before) << size;
  }
}

/// A stopped, traced child process. This program's `ptrace` is uml_xstate's, which calls amx_host's.
class Tracee : public testing::Test {
 protected:
  void SetUp() override {
    process = fork();
    if (process == 0) {
      ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
      (void)std::raise(SIGSTOP);
      _exit(0);
    }
    ASSERT_EQ(waitpid(process, nullptr, 0), process);
  }
  void TearDown() override {
    (void)kill(process, SIGKILL);
    (void)waitpid(process, nullptr, 0);
  }

  std::vector<std::byte> registers(std::size_t size) const {
    std::vector<std::byte> area(size);
    iovec all{area.data(), area.size()};
    EXPECT_EQ(ptrace(PTRACE_GETREGSET, process, note, &all), 0);
    return area;
  }

  static constexpr std::size_t xmm0 = 160;  ///< offset in an area (SDM volume 1, table 10-2)
  void* const note = reinterpret_cast<void*>(NT_X86_XSTATE);
  pid_t process = -1;
};

TEST_F(Tracee, OnAHostWithAmxTakesNoBeginning) {
  void* const host = dlopen("libamx_host.so", RTLD_NOW | RTLD_NOLOAD);
  ASSERT_NE(host, nullptr) << dlerror();
  const auto host_ptrace = reinterpret_cast<decltype(&ptrace)>(dlsym(host, "ptrace"));
  std::vector<std::byte> area = registers(uml_size);
  iovec beginning{area.data(), area.size()};
  EXPECT_EQ(host_ptrace(PTRACE_SETREGSET, process, note, &beginning), -1);
  EXPECT_EQ(errno, EFAULT);
}

TEST_F(Tracee, TakesTheRegistersOfABeginningThroughOurPtrace) {
  std::vector<std::byte> area = registers(uml_size);
  const std::byte changed = area[xmm0] ^ std::byte{0xFF};
  area[xmm0] = changed;
  set_parts_in_use(area, parts_in_use(area) | 0x3);  // x87 and SSE are in use
  iovec beginning{area.data(), area.size()};
  errno = 0;

  EXPECT_EQ(ptrace(PTRACE_SETREGSET, process, note, &beginning), 0);

  EXPECT_EQ(errno, 0);
  EXPECT_EQ(beginning.iov_len, uml_size);
  EXPECT_EQ(registers(uml_size)[xmm0], changed);
}

TEST_F(Tracee, OtherFaultsOfThatCallStayWhatTheyAre) {
  std::vector<std::byte> area(header_begin);
  iovec beginning{area.data(), area.size()};
  EXPECT_EQ(ptrace(PTRACE_SETREGSET, process, note, &beginning), -1);
  EXPECT_EQ(errno, EFAULT);
  EXPECT_EQ(ptrace(PTRACE_SETREGSET, -1, note, &beginning), -1);
}

}  // namespace
}  // namespace lodestar::xstate
