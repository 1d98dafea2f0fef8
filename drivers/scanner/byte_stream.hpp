#pragma once

#include "drivers/scanner/bytes.hpp"

namespace lodestar {

/// The bytes of a stream that have arrived and are not yet understood.
class ByteStream {
 public:
  void append(ByteView bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

  [[nodiscard]] ByteView front() const { return ByteView(bytes_).subspan(taken_); }

  void drop(std::size_t count) {
    taken_ += count;
    position_ += count;
    if (2 * taken_ < bytes_.size()) return;
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(taken_));
    taken_ = 0;
  }

  void clear() { drop(front().size()); }

  /// Bytes dropped since the beginning.
  [[nodiscard]] std::uint64_t position() const { return position_; }

 private:
  Bytes bytes_;
  std::size_t taken_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace lodestar
