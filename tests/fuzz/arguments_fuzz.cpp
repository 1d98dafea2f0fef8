#include <cmath>
#include <cstdint>

#include "app/site/arguments.hpp"
#include "maps/input_error.hpp"

// A goal on the command line is refused with an InputError, or is finite.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const Goal goal = parse_goal("--goal", text);
    if (!goal.position_m.allFinite()) __builtin_trap();
    if (goal.heading_rad && !std::isfinite(*goal.heading_rad)) __builtin_trap();
  } catch (const InputError&) {
  }
  try {
    const Places places{.places = {{"desk", Vec2::Ones(), std::nullopt}}};
    if (!parse_goal("--goal", text, places).position_m.allFinite()) __builtin_trap();
  } catch (const InputError&) {
  }
  try {
    if (!parse_point("--start", text).allFinite()) __builtin_trap();
  } catch (const InputError&) {
  }
  return 0;
}
