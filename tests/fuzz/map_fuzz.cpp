#include <algorithm>

#include "maps/input_error.hpp"
#include "maps/map_file.hpp"

#include "tests/fuzz/scratch_file.hpp"

// The input is a map's YAML up to the first NUL, and its image after it. The YAML may name no file but ours.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  const std::uint8_t* const cut = std::find(data, data + size, std::uint8_t{0});
  const std::uint8_t* const image = cut == data + size ? cut : cut + 1;
  scratch_file("map.pgm", image, static_cast<std::size_t>(data + size - image));
  const auto file = scratch_file("map.yaml", data, static_cast<std::size_t>(cut - data));
  try {
    const LoadedMap loaded = load_map(file);
    const OccupancyMap& map = loaded.map;
    if (map.cells.size() != static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows)) {
      __builtin_trap();
    }
  } catch (const InputError&) {
  }
  return 0;
}
