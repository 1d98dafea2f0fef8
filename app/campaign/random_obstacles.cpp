#include "app/campaign/random_obstacles.hpp"

#include "app/campaign/random_doors.hpp"
#include "app/campaign/random_things.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

// Streams of the seed, beside those of a campaign's mission.
constexpr std::uint64_t things_stream = 5;
constexpr std::uint64_t doors_stream = 6;

}  // namespace

void add_random_obstacles(const Site& site, std::uint64_t seed, SimulatedDriveOptions& options) {
  const Random random(seed);
  options.discs = random_things(site, random.stream(things_stream).bits());
  if (const auto door = random_door(site, options.discs, random.stream(doors_stream).bits()))
    options.doors.push_back(*door);
}

}  // namespace lodestar
