#include "drivers/base/protocol_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace lodestar {
namespace {

std::uint64_t mask_of(int bits) {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << static_cast<unsigned>(bits)) - 1U;
}

int bytes_of(const Signal& signal) {
  return (signal.bit + signal.bits + 7) / 8;
}

/// Position in the frame of the signal's byte i, counted from the least significant one.
std::size_t place_of(const Signal& signal, ByteOrder order, int i) {
  const int offset = order == ByteOrder::little_endian ? i : bytes_of(signal) - 1 - i;
  return static_cast<std::size_t>(signal.byte + offset);
}

std::uint64_t read_bits(const Signal& signal, ByteOrder order, const CanFrame& frame) {
  std::uint64_t raw = 0;
  for (int i = bytes_of(signal) - 1; i >= 0; --i) raw = (raw << 8U) | frame.data[place_of(signal, order, i)];
  return (raw >> static_cast<unsigned>(signal.bit)) & mask_of(signal.bits);
}

void write_bits(const Signal& signal, ByteOrder order, std::uint64_t bits, CanFrame& frame) {
  std::uint64_t raw = (bits & mask_of(signal.bits)) << static_cast<unsigned>(signal.bit);
  for (int i = 0; i < bytes_of(signal); ++i, raw >>= 8U) {
    frame.data[place_of(signal, order, i)] |= static_cast<std::uint8_t>(raw & 0xFFU);
  }
}

/// The range of raw integers.
SignalRange raw_range_of(const Signal& signal) {
  if (signal.kind == SignalKind::unsigned_integer) return {0.0, std::ldexp(1.0, signal.bits) - 1.0};
  return {-std::ldexp(1.0, signal.bits - 1), std::ldexp(1.0, signal.bits - 1) - 1.0};
}

/// The only place where raw integers are scaled: for a scale of 1/n, division gives the nearest double.
double scaled(double whole, double scale) {
  const double steps_per_unit = 1.0 / scale;
  return steps_per_unit == std::round(steps_per_unit) ? whole / steps_per_unit : whole * scale;
}

double value_of(const Signal& signal, std::uint64_t bits) {
  if (signal.kind == SignalKind::float32) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(bits)) * signal.scale;
  }
  const bool is_negative = signal.kind == SignalKind::signed_integer &&
                           ((bits >> static_cast<unsigned>(signal.bits - 1)) & 1U) != 0;
  const double whole = static_cast<double>(bits) - (is_negative ? std::ldexp(1.0, signal.bits) : 0.0);
  return scaled(whole, signal.scale);
}

std::uint64_t bits_of(const Signal& signal, double value) {
  if (std::isnan(value)) return 0;
  if (signal.kind == SignalKind::float32) {
    const SignalRange range = range_of(signal);
    return std::bit_cast<std::uint32_t>(
        static_cast<float>(std::clamp(value, range.low, range.high) / signal.scale));
  }
  const SignalRange raw = raw_range_of(signal);
  const double whole = std::clamp(std::round(value / signal.scale), raw.low, raw.high);
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(whole));
}

int dbc_start_bit(const Signal& signal, ByteOrder order) {
  if (order == ByteOrder::little_endian) return 8 * signal.byte + signal.bit;
  return 8 * signal.byte + std::min(7, signal.bit + signal.bits - 1);
}

std::string signal_line(const Signal& signal, const MessageSpec& message) {
  const SignalRange range = range_of(signal);
  return fmt::format(" SG_ {} : {}|{}@{}{} ({:.12g},0) [{:.12g}|{:.12g}] \"{}\" {}\n", signal.name,
                     dbc_start_bit(signal, message.order), signal.bits,
                     message.order == ByteOrder::little_endian ? 1 : 0,
                     signal.kind == SignalKind::unsigned_integer ? '+' : '-', signal.scale, range.low,
                     range.high, signal.unit, message.sender == Sender::host ? "Base" : "Host");
}

}  // namespace

CanFrame encode(const MessageSpec& message, const SignalValues& values, std::uint32_t id_offset) {
  CanFrame frame{message.id + id_offset, message.length, {}};
  for (std::size_t i = 0; i < message.signals.size(); ++i) {
    const Signal& signal = message.signals[i];
    if (signal.byte + bytes_of(signal) > message.length) continue;
    write_bits(signal, message.order, bits_of(signal, values.at(i)), frame);
  }
  return frame;
}

std::optional<SignalValues> decode(const MessageSpec& message, const CanFrame& frame,
                                   std::uint32_t id_offset) {
  if (frame.id != message.id + id_offset || frame.length < message.least_length) return std::nullopt;
  SignalValues values{};
  for (std::size_t i = 0; i < message.signals.size(); ++i) {
    const Signal& signal = message.signals[i];
    if (signal.byte + bytes_of(signal) > frame.length) continue;
    values.at(i) = value_of(signal, read_bits(signal, message.order, frame));
    if (!std::isfinite(values.at(i))) return std::nullopt;
  }
  return values;
}

SignalRange range_of(const Signal& signal) {
  if (signal.kind == SignalKind::float32) {
    constexpr double most = std::numeric_limits<float>::max();
    return {-most * signal.scale, most * signal.scale};
  }
  const SignalRange raw = raw_range_of(signal);
  return {scaled(raw.low, signal.scale), scaled(raw.high, signal.scale)};
}

std::string dbc_text(const ProtocolTable& table) {
  std::string text = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: Host Base\n\n";
  std::string attributes =
      "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\nBA_DEF_ BO_ \"GenMsgTimeout\" INT 0 65535;\n"
      "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\nBA_DEF_DEF_ \"GenMsgTimeout\" 0;\n";
  std::string value_types;
  const auto milliseconds_of = [](Duration time) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(time).count();
  };
  for (int node = 0; node < table.nodes; ++node) {
    const std::string prefix = table.nodes > 1 ? fmt::format("Axis{}_", node) : "";
    for (const MessageSpec& message : table.messages) {
      const std::uint32_t id = message.id + static_cast<std::uint32_t>(node) * table.node_step;
      text += fmt::format("BO_ {} {}{}: {} {}\n", id, prefix, message.name, message.length,
                          message.sender == Sender::host ? "Host" : "Base");
      for (const Signal& signal : message.signals) {
        text += signal_line(signal, message);
        if (signal.kind == SignalKind::float32)
          value_types += fmt::format("SIG_VALTYPE_ {} {} : 1;\n", id, signal.name);
      }
      text += "\n";
      if (message.period > Duration::zero()) {
        attributes +=
            fmt::format("BA_ \"GenMsgCycleTime\" BO_ {} {};\n", id, milliseconds_of(message.period));
      }
      if (message.timeout > Duration::zero()) {
        attributes += fmt::format("BA_ \"GenMsgTimeout\" BO_ {} {};\n", id, milliseconds_of(message.timeout));
      }
    }
  }
  return text + attributes + value_types;
}

}  // namespace lodestar
