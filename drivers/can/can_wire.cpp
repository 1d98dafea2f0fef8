#include "drivers/can/can_wire.hpp"

#include <algorithm>

namespace lodestar {
namespace {

/// Counts the bits of the stuffed part of a frame and computes its CRC.
class StuffedPart {
 public:
  void push(unsigned value, int bits) {
    for (int i = bits - 1; i >= 0; --i) push_bit((value >> static_cast<unsigned>(i)) & 1U);
  }

  [[nodiscard]] unsigned check_sum() const { return check_sum_; }
  [[nodiscard]] int bits() const { return bits_; }

 private:
  void push_bit(unsigned bit) {
    update_check_sum(bit);
    ++bits_;
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    if (run_ < 5) return;
    // After five equal bits the sender inserts one of opposite value, which begins the next run.
    ++bits_;
    run_ = 1;
    last_ = 1U - bit;
  }

  void update_check_sum(unsigned bit) {
    const bool divide = (bit ^ (check_sum_ >> 14U)) != 0;
    check_sum_ = (check_sum_ << 1U) & 0x7FFFU;
    if (divide) check_sum_ ^= 0x4599U;
  }

  unsigned last_ = 2;  // neither 0 nor 1: no run yet
  int run_ = 0;
  int bits_ = 0;
  unsigned check_sum_ = 0;
};

constexpr int check_sum_bits = 15;
/// CRC delimiter 1, acknowledge 2, end of frame 7, interframe space 3: never stuffed.
constexpr int unstuffed_bits = 13;

}  // namespace

int bits_on_wire(const CanFrame& frame) {
  StuffedPart part;
  part.push(0, 1);  // start of frame
  part.push(frame.id & 0x7FFU, 11);
  part.push(0, 3);  // data frame, 11-bit identifier, reserved bit
  const unsigned length = std::min<unsigned>(frame.length, 8);
  part.push(length, 4);
  for (unsigned i = 0; i < length; ++i) part.push(frame.data[i], 8);
  part.push(part.check_sum(), check_sum_bits);
  return part.bits() + unstuffed_bits;
}

}  // namespace lodestar
