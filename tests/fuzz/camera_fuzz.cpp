#include <cmath>

#include "maps/camera_model.hpp"
#include "maps/input_error.hpp"

#include "tests/fuzz/scratch_file.hpp"

// A camera file is refused with an InputError, or gives a camera with finite numbers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  try {
    const CameraModel camera = load_camera(scratch_file("camera.yaml", data, size));
    if (!std::isfinite(camera.fx_px) || !std::isfinite(camera.cy_px)) __builtin_trap();
  } catch (const InputError&) {
  }
  return 0;
}
