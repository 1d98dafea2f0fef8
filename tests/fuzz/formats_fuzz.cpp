#include <cmath>
#include <cstdint>

#include "app/placement/formats.hpp"
#include "maps/input_error.hpp"

// The first byte chooses a format of marker maps, the rest is the text. It is refused with an InputError, or
// is written in the same format and read again to the same markers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  if (size == 0) return 0;
  const std::vector<std::string>& names = marker_format_names();
  const auto format = static_cast<MarkerFormat>(data[0] % names.size());
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  (void)guess_marker_format("markers.yaml", text);
  MarkerRegistry read;
  try {
    read = parse_markers(text, format, "fuzz");
  } catch (const InputError&) {
    return 0;
  }
  for (const RegisteredMarker& marker : read.markers) {
    if (!marker.position_m.allFinite() || !std::isfinite(marker.yaw_rad)) __builtin_trap();
  }
  const MarkerRegistry again = parse_markers(markers_text(read, format), format, "again");
  if (again.markers.size() != read.markers.size()) __builtin_trap();
  return 0;
}
