#include "drivers/can/candump.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fstream>
#include <istream>
#include <optional>
#include <ostream>
#include <string_view>

#include "drivers/can/can_wire.hpp"
#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

/// Parses a line from the left; each step returns whether it found what it expected.
class LineReader {
 public:
  explicit LineReader(std::string_view line) : rest_(line) {}

  bool skip(char wanted) {
    if (rest_.empty() || rest_.front() != wanted) return false;
    rest_.remove_prefix(1);
    return true;
  }

  /// Everything up to one of `ends`, or to the end of the line.
  std::string_view up_to(std::string_view ends) {
    const std::size_t length = std::min(rest_.find_first_of(ends), rest_.size());
    const std::string_view word = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return word;
  }

  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

/// The whole text as a number, digits of that base only.
template <typename Number>
std::optional<Number> number(std::string_view digits, int base) {
  Number value{};
  const char* const end = digits.data() + digits.size();
  const bool signed_text = !digits.empty() && digits.front() == '-';
  const auto [stop, error] = std::from_chars(digits.data(), end, value, base);
  if (digits.empty() || signed_text || error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::optional<Stamp> parse_stamp(std::string_view seconds_text, std::string_view decimals_text) {
  constexpr std::int64_t most_seconds = 9'000'000'000;  // fits 64 bits of nanoseconds
  if (decimals_text.size() != 6 && decimals_text.size() != 9) return std::nullopt;
  const auto whole = number<std::int64_t>(seconds_text, 10);
  const auto decimals = number<std::int64_t>(decimals_text, 10);
  if (!whole || !decimals || *whole > most_seconds) return std::nullopt;
  const std::int64_t nanoseconds = decimals_text.size() == 6 ? *decimals * 1000 : *decimals;
  return Stamp(std::chrono::seconds(*whole) + Duration(nanoseconds));
}

std::optional<CanFrame> parse_frame(std::string_view id_text, std::string_view data_text) {
  const auto id = number<std::uint32_t>(id_text, 16);
  if (id_text.size() != 3 || !id || data_text.size() % 2 != 0 || data_text.size() > 16) return std::nullopt;
  CanFrame frame{*id, static_cast<std::uint8_t>(data_text.size() / 2), {}};
  for (std::size_t i = 0; i < frame.length; ++i) {
    const auto byte = number<std::uint8_t>(data_text.substr(2 * i, 2), 16);
    if (!byte) return std::nullopt;
    frame.data[i] = *byte;
  }
  return is_valid(frame) ? std::optional(frame) : std::nullopt;
}

std::optional<LoggedCanFrame> parse_line(std::string_view text) {
  LineReader line(text);
  if (!line.skip('(')) return std::nullopt;
  const std::string_view whole = line.up_to(".");
  if (!line.skip('.')) return std::nullopt;
  const std::string_view decimals = line.up_to(")");
  if (!line.skip(')') || !line.skip(' ')) return std::nullopt;
  const std::string_view interface = line.up_to(" ");
  if (interface.empty() || !line.skip(' ')) return std::nullopt;
  const std::string_view id = line.up_to("#");
  if (!line.skip('#')) return std::nullopt;
  const std::string_view data = line.up_to(" ");
  if (!line.at_end() && !(line.skip(' ') && (line.skip('R') || line.skip('T')) && line.at_end())) {
    return std::nullopt;
  }

  const auto stamp = parse_stamp(whole, decimals);
  const auto frame = parse_frame(id, data);
  if (!stamp || !frame) return std::nullopt;
  return LoggedCanFrame{{*stamp, *frame}, std::string(interface)};
}

/// A printable excerpt of an arbitrary line, for messages.
std::string shown(std::string_view text) {
  constexpr std::size_t most = 60;
  std::string result = "'";
  for (const char c : text.substr(0, most)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > most ? "...'" : "'");
}

}  // namespace

std::string candump_line(const StampedCanFrame& frame, const std::string& interface) {
  const auto since_start = frame.stamp.time_since_epoch();
  const auto whole = std::chrono::floor<std::chrono::seconds>(since_start);
  const auto rest = std::chrono::floor<std::chrono::microseconds>(since_start - whole);
  std::string line =
      fmt::format("({:010}.{:06}) {} {:03X}#", whole.count(), rest.count(), interface, frame.frame.id);
  for (std::size_t i = 0; i < frame.frame.length && i < frame.frame.data.size(); ++i) {
    line += fmt::format("{:02X}", frame.frame.data[i]);
  }
  return line;
}

CandumpWriter::CandumpWriter(std::ostream& out, std::string interface)
    : out_(out), interface_(std::move(interface)) {}

void CandumpWriter::write(const StampedCanFrame& frame) {
  out_ << candump_line(frame, interface_) << '\n';
}

std::vector<LoggedCanFrame> read_candump(std::istream& in, const std::filesystem::path& file) {
  std::vector<LoggedCanFrame> frames;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    auto frame = parse_line(text);
    if (!frame) {
      throw InputError(file, line, shown(text),
                       "a candump line like '(1700000000.123456) can0 123#1122' with an 11-bit identifier");
    }
    frames.push_back(std::move(*frame));
  }
  return frames;
}

std::vector<LoggedCanFrame> load_candump(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || is_folder(file)) {
    throw InputError(file, 0, "a file that cannot be read", "a candump log");
  }
  return read_candump(in, file);
}

}  // namespace lodestar
