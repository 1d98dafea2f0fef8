#include <charconv>
#include <fmt/format.h>
#include <string_view>

#include "drivers/scanner/ld19_protocol.hpp"
#include "drivers/scanner/nanoscan_protocol.hpp"
#include "drivers/scanner/rplidar_protocol.hpp"
#include "drivers/scanner/scanner_driver.hpp"
#include "drivers/scanner/scip_protocol.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

[[noreturn]] void refuse_address(const std::string& address) {
  throw InputError(fmt::format(
      "scanner: found '{}', wanted ld19:DEVICE, rplidar:DEVICE[@BAUD], scip:HOST[:PORT], scip:DEVICE or "
      "nanoscan:UDP_PORT, such as ld19:/dev/ttyUSB0",
      address));
}

/// A whole number of 1 to `most`.
std::optional<unsigned> number_in(std::string_view text, unsigned most) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value == 0 || value > most)
    return std::nullopt;
  return value;
}

/// What stands before the last `separator`, and the number after it, or the usual one.
struct NumberedPlace {
  std::string place;
  unsigned number = 0;
};
std::optional<NumberedPlace> split(const std::string& text, char separator, unsigned usual, unsigned most) {
  const std::size_t at = text.rfind(separator);
  if (at == std::string::npos) return NumberedPlace{text, usual};
  const std::optional<unsigned> number = number_in(std::string_view(text).substr(at + 1), most);
  if (!number || at == 0) return std::nullopt;
  return NumberedPlace{text.substr(0, at), *number};
}

constexpr unsigned most_baud = 4'000'000;
constexpr unsigned most_port = 65535;

}  // namespace

std::unique_ptr<Scanner> open_scanner(const std::string& address) {
  const std::size_t colon = address.find(':');
  if (colon == std::string::npos || colon + 1 == address.size()) refuse_address(address);
  const std::string protocol = address.substr(0, colon);
  const std::string place = address.substr(colon + 1);
  const bool is_device = place.front() == '/';
  if (protocol == "ld19" && is_device)
    return std::make_unique<ScannerDriver>([place] { return open_serial(place, Ld19Protocol::baud); },
                                           std::make_unique<Ld19Protocol>());
  if (protocol == "rplidar" && is_device) {
    if (const auto line = split(place, '@', RplidarProtocol::baud, most_baud))
      return std::make_unique<ScannerDriver>(
          [line = *line] { return open_serial(line.place, line.number, false); },
          std::make_unique<RplidarProtocol>());
  }
  if (protocol == "scip" && is_device)
    return std::make_unique<ScannerDriver>([place] { return open_serial(place, ScipProtocol::baud); },
                                           std::make_unique<ScipProtocol>());
  if (protocol == "scip" && !is_device) {
    if (const auto host = split(place, ':', ScipProtocol::tcp_port, most_port))
      return std::make_unique<ScannerDriver>([host = *host] { return open_tcp(host.place, host.number); },
                                             std::make_unique<ScipProtocol>());
  }
  if (protocol == "nanoscan") {
    if (const auto port = number_in(place, most_port))
      return std::make_unique<ScannerDriver>([port = *port] { return open_udp(port); },
                                             std::make_unique<NanoscanProtocol>());
  }
  refuse_address(address);
}

}  // namespace lodestar
