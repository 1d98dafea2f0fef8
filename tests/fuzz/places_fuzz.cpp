#include <string>

#include "maps/input_error.hpp"
#include "maps/places.hpp"

// Places are refused with an InputError, or are written as a text that is read again to the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const auto parse : {parse_places, parse_routes}) {
    Places read;
    try {
      read = parse(text, "places.yaml");
    } catch (const InputError&) {
      continue;
    }
    const std::string written = places_text(read);
    const Places again = parse_places(written, "places.yaml");
    if (places_text(again) != written) __builtin_trap();
    for (const Place& place : read.places)
      if (again.find(place.name) == nullptr || !place.position_m.allFinite()) __builtin_trap();
    for (const RouteEdge& edge : read.edges)
      if (!again.position_m(edge.from) || !again.position_m(edge.to)) __builtin_trap();
  }
  return 0;
}
