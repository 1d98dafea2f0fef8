#pragma once

#include <array>
#include <cstdint>
#include <cstring>

// Sixteen pixels in a register. Only vector extensions that GCC and clang share are used: they compile to
// SSE2 or AVX2 on x86-64 and to NEON on arm64, with identical results.
namespace lodestar {

using SixteenPixels [[gnu::vector_size(16)]] = std::uint8_t;
/// Result of a comparison: all bits of a byte, or none.
using SixteenAnswers [[gnu::vector_size(16)]] = signed char;

[[gnu::always_inline]] inline SixteenPixels sixteen_at(const std::uint8_t* pixels) {
  SixteenPixels loaded;
  std::memcpy(&loaded, pixels, sizeof(loaded));
  return loaded;
}

[[gnu::always_inline]] inline SixteenPixels least_of(const SixteenPixels& a, const SixteenPixels& b) {
  return a < b ? a : b;
}

/// Bit i is set where answer i is true. A multiplication gathers the lowest bits of eight bytes in the top
/// byte.
[[gnu::always_inline]] inline std::uint32_t packed_bits_of(const SixteenAnswers& answers) {
  std::array<std::uint64_t, 2> halves;
  std::memcpy(halves.data(), &answers, sizeof(answers));
  const auto packed = [](std::uint64_t bytes) {
    return static_cast<std::uint32_t>((bytes & 0x0101010101010101U) * 0x0102040810204080U >> 56U);
  };
  return packed(halves[0]) | packed(halves[1]) << 8U;
}

/// The same. x86-64 has one instruction for it, to which no portable vector operation compiles.
[[gnu::always_inline]] inline std::uint32_t bits_of(const SixteenAnswers& answers) {
#ifdef __SSE2__
  using Chars [[gnu::vector_size(16)]] = char;
  return static_cast<std::uint32_t>(__builtin_ia32_pmovmskb128(reinterpret_cast<const Chars&>(answers)));
#else
  return packed_bits_of(answers);
#endif
}

}  // namespace lodestar
