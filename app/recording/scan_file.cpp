#include "app/recording/scan_file.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string_view>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

constexpr std::string_view magic = "LSTRSCAN";
constexpr std::uint32_t version = 1;
constexpr std::uint32_t record_mark = 0x4e414353;  // "SCAN"
constexpr std::size_t header_bytes = 8 + 4 + 4 * 8;
constexpr std::size_t record_head_bytes = 4 + 4 + 8 + 8 + 8;
constexpr std::size_t beam_bytes = 8 + 8 + 8 + 4 + 1;
constexpr std::size_t check_bytes = 4;
constexpr std::uint32_t most_beams = 100'000;  ///< 31 times those of the finest scanner supported

/// CRC-32 of IEEE 802.3, as zlib's crc32().
std::uint32_t crc32(std::string_view bytes) {
  static constexpr std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> values{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      values[i] = i;
      for (int bit = 0; bit < 8; ++bit)
        values[i] = (values[i] >> 1U) ^ ((values[i] & 1U) != 0 ? 0xedb88320U : 0U);
    }
    return values;
  }();
  std::uint32_t crc = 0xffffffffU;
  for (const char byte : bytes) crc = table[(crc ^ static_cast<std::uint8_t>(byte)) & 0xffU] ^ (crc >> 8U);
  return ~crc;
}

/// Least byte first, on every machine.
template <typename Unsigned>
void put(std::string& bytes, Unsigned value) {
  for (std::size_t i = 0; i < sizeof value; ++i)
    bytes.push_back(static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i))));
}
void put(std::string& bytes, double value) {
  put(bytes, std::bit_cast<std::uint64_t>(value));
}
void put(std::string& bytes, Stamp stamp) {
  put(bytes, static_cast<std::uint64_t>(stamp.time_since_epoch().count()));
}

/// Takes values from the front of bytes that are long enough for them.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : bytes_(bytes) {}

  template <typename Unsigned>
  Unsigned whole() {
    Unsigned value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i)
      value = static_cast<Unsigned>(
          value |
          static_cast<Unsigned>(static_cast<Unsigned>(static_cast<std::uint8_t>(bytes_[i])) << (8 * i)));
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  double number() { return std::bit_cast<double>(whole<std::uint64_t>()); }
  Stamp stamp() { return Stamp(Duration(static_cast<std::int64_t>(whole<std::uint64_t>()))); }

 private:
  std::string_view bytes_;
};

bool is_mount(const ScannerMount& mount) {
  const Pose2& pose = mount.base_from_scanner;
  constexpr double far_m = 100.0;
  return pose.position_m.cwiseAbs().maxCoeff() < far_m && std::abs(mount.height_m) < far_m &&
         std::abs(pose.yaw_rad) <= 2.0 * std::numbers::pi;  // each is false for what is no number
}

bool is_possible(const Beam& beam) {
  const bool has_range = beam.echo != Echo::hit || (std::isfinite(beam.range_m) && beam.range_m >= 0.0);
  return has_range && std::abs(beam.angle_rad) <= 2.0 * std::numbers::pi;
}

}  // namespace

std::string scan_file_header(const ScannerMount& mount) {
  std::string bytes(magic);
  put(bytes, version);
  put(bytes, mount.base_from_scanner.position_m.x());
  put(bytes, mount.base_from_scanner.position_m.y());
  put(bytes, mount.base_from_scanner.yaw_rad);
  put(bytes, mount.height_m);
  return bytes;
}

std::string scan_file_record(const LoggedScan& logged) {
  const Scan& scan = logged.scan;
  std::string bytes;
  bytes.reserve(record_head_bytes + beam_bytes * scan.beams.size() + check_bytes);
  put(bytes, record_mark);
  put(bytes, static_cast<std::uint32_t>(scan.beams.size()));
  put(bytes, logged.arrival);
  put(bytes, scan.min_range_m);
  put(bytes, scan.max_range_m);
  for (const Beam& beam : scan.beams) {
    put(bytes, beam.stamp);
    put(bytes, beam.angle_rad);
    put(bytes, beam.range_m);
    put(bytes, std::bit_cast<std::uint32_t>(beam.intensity));
    put(bytes, static_cast<std::uint8_t>(beam.echo));
  }
  put(bytes, crc32(bytes));
  return bytes;
}

ScanFileReader::ScanFileReader(const std::filesystem::path& file) : file_(file), in_(file, std::ios::binary) {
  if (!in_) throw InputError(file, 0, "no file that can be read", "the scans of a drive");
  const std::string bytes = read(header_bytes);
  if (!bytes.starts_with(magic)) refuse("other bytes", fmt::format("'{}': the scans of a drive", magic));
  if (bytes.size() < header_bytes)
    refuse(fmt::format("a header of {} bytes", bytes.size()), fmt::format("{}", header_bytes));
  Taker taker(std::string_view(bytes).substr(magic.size()));
  if (const auto found = taker.whole<std::uint32_t>(); found != version)
    refuse(fmt::format("version {}", found), fmt::format("version {}", version));
  const double x_m = taker.number();
  const double y_m = taker.number();
  mount_.base_from_scanner = {{x_m, y_m}, taker.number()};
  mount_.height_m = taker.number();
  if (!is_mount(mount_)) refuse("a scanner that cannot sit there", "its place in the base frame");
  offset_ = header_bytes;
}

std::optional<LoggedScan> ScanFileReader::next() {
  const std::string head = read(record_head_bytes);
  if (head.size() < record_head_bytes) {
    cut_off_ = head.size();
    return std::nullopt;
  }
  Taker taker(head);
  if (taker.whole<std::uint32_t>() != record_mark) refuse("other bytes", "a record: 'SCAN'");
  const auto beams = taker.whole<std::uint32_t>();
  if (beams > most_beams)
    refuse(fmt::format("a scan of {} beams", beams), fmt::format("at most {}", most_beams));
  const std::string rest = read(beam_bytes * beams + check_bytes);
  if (rest.size() < beam_bytes * beams + check_bytes) {
    cut_off_ = head.size() + rest.size();
    return std::nullopt;
  }
  const std::string_view body = std::string_view(rest).substr(0, rest.size() - check_bytes);
  if (Taker(std::string_view(rest).substr(body.size())).whole<std::uint32_t>() !=
      crc32(head + std::string(body)))
    refuse("a record that does not agree with its checksum", "the bytes that were written");

  LoggedScan logged{.arrival = taker.stamp()};
  logged.scan.min_range_m = taker.number();
  logged.scan.max_range_m = taker.number();
  if (!(logged.scan.min_range_m >= 0.0) || !(logged.scan.max_range_m >= logged.scan.min_range_m))
    refuse(fmt::format("ranges from {} to {} m", logged.scan.min_range_m, logged.scan.max_range_m),
           "limits in ascending order, from 0");
  logged.scan.beams.reserve(beams);
  Taker beam_taker(body);
  for (std::uint32_t i = 0; i < beams; ++i) {
    Beam beam{.stamp = beam_taker.stamp()};
    beam.angle_rad = beam_taker.number();
    beam.range_m = beam_taker.number();
    beam.intensity = std::bit_cast<float>(beam_taker.whole<std::uint32_t>());
    const auto echo = beam_taker.whole<std::uint8_t>();
    beam.echo = static_cast<Echo>(echo);
    if (echo > static_cast<std::uint8_t>(Echo::invalid) || !is_possible(beam))
      refuse(fmt::format("beam {}: echo {}, {} rad, {} m", i, echo, beam.angle_rad, beam.range_m),
             "an echo from 0 to 3, an angle within a turn, and the range of a hit");
    logged.scan.beams.push_back(beam);
  }
  offset_ += head.size() + rest.size();
  return logged;
}

/// Up to so many bytes; fewer at the end of the file.
std::string ScanFileReader::read(std::size_t count) {
  std::string bytes(count, '\0');
  in_.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(in_.gcount()));
  return bytes;
}

void ScanFileReader::refuse(const std::string& found, const std::string& wanted) const {
  throw InputError(file_, 0, fmt::format("{} at byte {}", found, offset_), wanted);
}

}  // namespace lodestar
