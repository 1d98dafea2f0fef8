// Preloaded into User-Mode Linux: its `ptrace`, on hosts whose CPU has AMX. Linux 6.1 writes floating-point
// registers as areas of 2696 bytes, the largest of its time. A host accepts only a whole area (else EFAULT),
// and with AMX an area has 11008 bytes. There the call is repeated with the whole area; a call that succeeds
// is left as it is.
#include <array>
#include <cerrno>
#include <cstdarg>
#include <dlfcn.h>
#include <elf.h>
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/uio.h>

#include "tests/can/xstate.hpp"

namespace lodestar {
namespace {

using Ptrace = long (*)(__ptrace_request, ...);

/// Looked up before main: User-Mode Linux calls from stacks too small for the dynamic linker.
const Ptrace next_ptrace = reinterpret_cast<Ptrace>(dlsym(RTLD_NEXT, "ptrace"));

constexpr std::size_t largest_area = 1U << 15;

/// Not on the stack, for the same reason; User-Mode Linux makes these calls one at a time.
alignas(64) std::array<std::byte, largest_area> area;

long set_whole_area(pid_t process, void* note, std::span<const std::byte> beginning) {
  iovec whole{area.data(), area.size()};
  if (next_ptrace(PTRACE_GETREGSET, process, note, &whole) < 0) return -1;
  if (!xstate::lay_over({area.data(), whole.iov_len}, beginning)) {
    errno = EFAULT;
    return -1;
  }
  return next_ptrace(PTRACE_SETREGSET, process, note, &whole);
}

}  // namespace
}  // namespace lodestar

extern "C" long ptrace(__ptrace_request request, ...) noexcept {
  using namespace lodestar;
  std::va_list arguments;
  va_start(arguments, request);
  const auto process = va_arg(arguments, pid_t);
  const auto address = va_arg(arguments, void*);
  const auto data = va_arg(arguments, void*);
  va_end(arguments);

  const int errno_before = errno;
  const long result = next_ptrace(request, process, address, data);
  const bool is_area = request == PTRACE_SETREGSET && address == reinterpret_cast<void*>(NT_X86_XSTATE);
  if (result == 0 || errno != EFAULT || !is_area) return result;

  const auto* const given = static_cast<const iovec*>(data);
  if (set_whole_area(process, address, {static_cast<const std::byte*>(given->iov_base), given->iov_len}) < 0)
    return -1;
  errno = errno_before;
  return 0;
}
