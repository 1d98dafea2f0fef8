// Simulates a host CPU with AMX for tests on hosts without: the XSAVE area of a process has 11008 bytes and
// marks the tile configuration as in use; a write is accepted only if whole and without AMX parts.
#include <algorithm>
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

const Ptrace next_ptrace = reinterpret_cast<Ptrace>(dlsym(RTLD_NEXT, "ptrace"));

constexpr std::size_t area_size = 11008;
constexpr std::uint64_t tile_configuration = 1U << 17;

alignas(64) std::array<std::byte, area_size> area;

long get_area(pid_t process, void* note, iovec& wanted) {
  area.fill(std::byte{0xA5});  // tile data that is not zero
  iovec here{area.data(), area.size()};
  if (next_ptrace(PTRACE_GETREGSET, process, note, &here) < 0) return -1;
  xstate::set_parts_in_use(area, xstate::parts_in_use(area) | tile_configuration);
  wanted.iov_len = std::min(wanted.iov_len, area_size);
  std::memcpy(wanted.iov_base, area.data(), wanted.iov_len);
  return 0;
}

long set_area(pid_t process, void* note, const iovec& given) {
  errno = EFAULT;
  if (given.iov_len < area_size) return -1;
  std::memcpy(area.data(), given.iov_base, area_size);
  errno = EINVAL;
  if ((xstate::parts_in_use(area) & xstate::amx_parts) != 0) return -1;
  iovec here{area.data(), area.size()};
  return next_ptrace(PTRACE_SETREGSET, process, note, &here);
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
  const bool is_area = address == reinterpret_cast<void*>(NT_X86_XSTATE);
  if (is_area && request == PTRACE_GETREGSET) return get_area(process, address, *static_cast<iovec*>(data));
  if (is_area && request == PTRACE_SETREGSET)
    return set_area(process, address, *static_cast<const iovec*>(data));
  return next_ptrace(request, process, address, data);
}
