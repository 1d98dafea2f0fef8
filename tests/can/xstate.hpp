#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

/// The XSAVE area of a process as PTRACE_GETREGSET and PTRACE_SETREGSET exchange it (NT_X86_XSTATE): 512
/// bytes of x87 and SSE registers, then a header whose first word, XSTATE_BV, has a bit for each part of the
/// area in use, then the other parts (Intel SDM volume 1, 13.4).
namespace lodestar::xstate {

constexpr std::size_t header_begin = 512;
constexpr std::size_t header_end = 576;
constexpr std::uint64_t amx_parts = 1U << 17 | 1U << 18;  ///< XTILECFG and XTILEDATA

inline std::uint64_t parts_in_use(std::span<const std::byte> area) {
  std::uint64_t parts = 0;
  std::memcpy(&parts, area.data() + header_begin, sizeof parts);
  return parts;
}

inline void set_parts_in_use(std::span<std::byte> area, std::uint64_t parts) {
  std::memcpy(area.data() + header_begin, &parts, sizeof parts);
}

/// Overwrites the beginning of a whole area. AMX is then marked as not in use: its registers are not part of
/// that beginning, and a process that has not requested AMX must not get any. False, without any change,
/// where the beginning does not include the header or is larger than the whole.
inline bool lay_over(std::span<std::byte> whole, std::span<const std::byte> beginning) {
  if (beginning.size() < header_end || beginning.size() > whole.size()) return false;
  std::memcpy(whole.data(), beginning.data(), beginning.size());
  set_parts_in_use(whole, parts_in_use(whole) & ~amx_parts);
  return true;
}

}  // namespace lodestar::xstate
