#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/can/can_bus.hpp"

// A CAN protocol as a table, as in a .dbc file: the same rows code frames, are checked, and are written out.
namespace lodestar {

enum class ByteOrder : std::uint8_t {
  big_endian,    ///< "Motorola"
  little_endian  ///< "Intel"
};
enum class SignalKind : std::uint8_t { unsigned_integer, signed_integer, float32 };
enum class Sender : std::uint8_t { host, base };

/// Some bits of a message, in whole bytes, or all within one byte. Value = bits * scale.
struct Signal {
  const char* name = "";
  int byte = 0;  ///< the first
  int bits = 8;
  SignalKind kind = SignalKind::unsigned_integer;
  double scale = 1.0;
  const char* unit = "";
  int bit = 0;  ///< the lowest, within a byte that it shares
};

struct MessageSpec {
  const char* name = "";
  std::uint32_t id = 0;  ///< of node 0
  Sender sender = Sender::host;
  std::uint8_t length = 8;        ///< as we send it
  std::uint8_t least_length = 8;  ///< that is accepted
  ByteOrder order = ByteOrder::big_endian;
  Duration period{};   ///< zero: on demand
  Duration timeout{};  ///< after which its receiver acts on its absence; zero: it does not
  std::span<const Signal> signals;
};

struct ProtocolTable {
  const char* name = "";
  std::span<const MessageSpec> messages;
  int nodes = 1;                ///< each has all the messages
  std::uint32_t node_step = 0;  ///< added to the identifiers from node to node
};

constexpr std::size_t most_signals = 8;
/// Physical values in the order of the message's signals; the rest is 0.
using SignalValues = std::array<double, most_signals>;

/// Rounds to the nearest step, saturates at what the bits can hold; NaN becomes 0. Bits of no signal are 0.
CanFrame encode(const MessageSpec& message, const SignalValues& values, std::uint32_t id_offset = 0);

/// Nothing for another identifier, a frame that is too short, or a number that is not finite.
std::optional<SignalValues> decode(const MessageSpec& message, const CanFrame& frame,
                                   std::uint32_t id_offset = 0);

/// What the bits of a signal can hold, as physical values.
struct SignalRange {
  double low = 0.0;
  double high = 0.0;
};
SignalRange range_of(const Signal& signal);

/// The protocol as the text of a .dbc file.
std::string dbc_text(const ProtocolTable& table);

}  // namespace lodestar
