#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/can/can_bus.hpp"

// A CAN protocol as a table, as in a .dbc file: the same rows encode and decode frames and are exported as
// .dbc.
namespace lodestar {

enum class ByteOrder : std::uint8_t {
  big_endian,    ///< "Motorola"
  little_endian  ///< "Intel"
};
enum class SignalKind : std::uint8_t { unsigned_integer, signed_integer, float32 };
enum class Sender : std::uint8_t { host, base };

/// A bit field of a message: whole bytes, or bits within one byte. Value = bits * scale.
struct Signal {
  const char* name = "";
  int byte = 0;  ///< first byte
  int bits = 8;
  SignalKind kind = SignalKind::unsigned_integer;
  double scale = 1.0;
  const char* unit = "";
  int bit = 0;  ///< lowest bit, if it shares its byte
};

struct MessageSpec {
  const char* name = "";
  std::uint32_t id = 0;  ///< identifier of node 0
  Sender sender = Sender::host;
  std::uint8_t length = 8;        ///< bytes, as sent
  std::uint8_t least_length = 8;  ///< fewest bytes accepted
  ByteOrder order = ByteOrder::big_endian;
  Duration period{};   ///< zero: on demand
  Duration timeout{};  ///< after which the receiver reacts to its absence; zero: never
  std::span<const Signal> signals;
};

struct ProtocolTable {
  const char* name = "";
  std::span<const MessageSpec> messages;
  int nodes = 1;                ///< each has all messages
  std::uint32_t node_step = 0;  ///< identifier offset from one node to the next
};

constexpr std::size_t most_signals = 8;
/// Physical values in the order of the message's signals; unused entries are 0.
using SignalValues = std::array<double, most_signals>;

/// Rounds to the nearest step and saturates at the range of the bits; NaN becomes 0. Unused bits are 0.
CanFrame encode(const MessageSpec& message, const SignalValues& values, std::uint32_t id_offset = 0);

/// Empty for another identifier, a frame that is too short, or a number that is not finite.
std::optional<SignalValues> decode(const MessageSpec& message, const CanFrame& frame,
                                   std::uint32_t id_offset = 0);

/// The range of a signal in physical values.
struct SignalRange {
  double low = 0.0;
  double high = 0.0;
};
SignalRange range_of(const Signal& signal);

/// The protocol as the text of a .dbc file.
std::string dbc_text(const ProtocolTable& table);

}  // namespace lodestar
