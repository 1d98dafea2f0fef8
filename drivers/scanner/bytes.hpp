#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Bytes of a wire protocol. Numbers of several bytes start with the lowest one, unless a name says otherwise.
namespace lodestar {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// The number of `Number`'s size at this place, which must lie within the bytes.
template <typename Number>
Number number_at(ByteView bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) value |= std::uint64_t{bytes[at + i]} << (8 * i);
  return static_cast<Number>(value);
}

template <typename Number>
void append_number(Bytes& bytes, Number number) {
  const auto value = static_cast<std::uint64_t>(number);
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// The exclusive or of all bytes.
inline std::uint8_t xor_of(ByteView bytes) {
  std::uint8_t sum = 0;
  for (const std::uint8_t byte : bytes) sum ^= byte;
  return sum;
}

inline void append(Bytes& bytes, ByteView more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

}  // namespace lodestar
