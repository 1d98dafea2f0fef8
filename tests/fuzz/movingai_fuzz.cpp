#include <algorithm>

#include "maps/input_error.hpp"
#include "maps/movingai_file.hpp"

#include "tests/fuzz/scratch_file.hpp"

// The input is a map in letters up to the first NUL, and queries after it. Both are refused with an
// InputError, or every query begins and ends at drivable cells.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  const std::uint8_t* const cut = std::find(data, data + size, std::uint8_t{0});
  const std::uint8_t* const rest = cut == data + size ? cut : cut + 1;
  const auto queries = scratch_file("fuzz.scen", rest, static_cast<std::size_t>(data + size - rest));
  try {
    const OccupancyMap map =
        load_movingai_map(scratch_file("fuzz.map", data, static_cast<std::size_t>(cut - data)));
    for (const MovingAiQuery& query : load_movingai_queries(queries, map)) {
      if (!is_drivable(map.at(query.start)) || !is_drivable(map.at(query.goal))) __builtin_trap();
    }
  } catch (const InputError&) {
  }
  return 0;
}
