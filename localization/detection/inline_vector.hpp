#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace lodestar {

/// Up to `most` values in a row that take no memory but their own: what a marker has of anything is known to
/// be little. A plain value; its iterators are pointers.
template <typename Value, std::size_t most>
class InlineVector {
 public:
  using value_type = Value;
  static constexpr std::size_t capacity = most;

  InlineVector() = default;

  /// There must be room.
  void push_back(const Value& value) {
    assert(size_ < most);
    values_[size_++] = value;
  }
  void clear() { size_ = 0; }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == most; }

  [[nodiscard]] Value* begin() { return values_.data(); }
  [[nodiscard]] Value* end() { return values_.data() + size_; }
  [[nodiscard]] const Value* begin() const { return values_.data(); }
  [[nodiscard]] const Value* end() const { return values_.data() + size_; }
  [[nodiscard]] Value* data() { return values_.data(); }
  [[nodiscard]] const Value* data() const { return values_.data(); }

  [[nodiscard]] Value& operator[](std::size_t i) { return values_[i]; }
  [[nodiscard]] const Value& operator[](std::size_t i) const { return values_[i]; }
  [[nodiscard]] Value& front() { return values_[0]; }
  [[nodiscard]] const Value& front() const { return values_[0]; }

 private:
  std::array<Value, most> values_{};
  std::size_t size_ = 0;
};

}  // namespace lodestar
