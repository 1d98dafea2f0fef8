#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>

namespace lodestar {

/// Serialization of DDS: plain CDR, little-endian, each number at a multiple of its size after the header of
/// four bytes (OMG DDSI-RTPS 2.3, 10; CORBA 3.1 part 2, 9.3).
class CdrBytes {
 public:
  template <typename Number>
    requires std::integral<Number> || std::floating_point<Number>
  void put(Number value) {
    static_assert(std::endian::native == std::endian::little);
    while ((bytes_.size() - header_bytes) % sizeof value != 0) bytes_ += '\0';
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof value);
  }
  /// With its length, which counts the zero at the end.
  void put(const char* text) {
    const std::size_t length = std::strlen(text) + 1;
    put(static_cast<std::uint32_t>(length));
    bytes_.append(text, length);
  }
  void raw(const void* from, std::size_t count) { bytes_.append(static_cast<const char*>(from), count); }

  [[nodiscard]] const std::string& get() const { return bytes_; }

 private:
  static constexpr std::size_t header_bytes = 4;
  std::string bytes_ = std::string("\0\1\0\0", header_bytes);
};

}  // namespace lodestar
