#include "maps/input_error.hpp"
#include "maps/marker_registry.hpp"

#include "tests/fuzz/scratch_file.hpp"

// A registry is refused with an InputError, or is written and read again to the same markers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  const std::filesystem::path file = scratch_file("markers.yaml", data, size);
  MarkerRegistry read;
  try {
    read = load_registry(file);
  } catch (const InputError&) {
    return 0;
  }
  save_registry(read, file);
  const MarkerRegistry again = load_registry(file);
  if (again.markers.size() != read.markers.size()) __builtin_trap();
  for (const RegisteredMarker& marker : read.markers) {
    if (again.find(marker.id) == nullptr) __builtin_trap();
  }
  return 0;
}
