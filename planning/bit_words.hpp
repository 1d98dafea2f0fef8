#pragma once

#include <cstdint>

namespace lodestar {

/// Of a row of bits, 64 to a word: those of one of the words from that of bit `first` to that of bit `last`
/// which lie between these two.
inline std::uint64_t bits_between(int word, int first, int last) {
  std::uint64_t bits = ~std::uint64_t{0};
  if (word == first / 64) bits &= ~std::uint64_t{0} << static_cast<unsigned>(first % 64);
  if (word == last / 64) bits &= ~std::uint64_t{0} >> static_cast<unsigned>(63 - last % 64);
  return bits;
}

}  // namespace lodestar
