#include <algorithm>
#include <cmath>
#include <string_view>

#include "app/site/site.hpp"
#include "maps/input_error.hpp"

#include "tests/fuzz/scratch_file.hpp"

namespace lodestar {
namespace {

void put(const std::string& name, std::string_view text) {
  scratch_file(name, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

/// The files that a site may name, as small as possible.
bool put_neighbours() {
  put("map.yaml",
      "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n"
      "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  put("map.pgm", "P2 2 1 255 254 0\n");
  put("markers.yaml",
      "format: lodestar-markers\nversion: 1\nalignment: {x_m: 0, y_m: 0, yaw_deg: 0}\nmarkers: []\n");
  put("camera.yaml",
      "image_width: 640\nimage_height: 480\ncamera_name: wide\n"
      "camera_matrix: {rows: 3, cols: 3, data: [320, 0, 319.5, 0, 320, 239.5, 0, 0, 1]}\n"
      "distortion_model: plumb_bob\n"
      "distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n");
  return true;
}

}  // namespace
}  // namespace lodestar

// The input is site.yaml up to the first NUL, and robot.yaml after it. A site is refused with an InputError,
// or has everything that a drive needs.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  [[maybe_unused]] static const bool once = put_neighbours();
  const std::uint8_t* const cut = std::find(data, data + size, std::uint8_t{0});
  const std::uint8_t* const robot = cut == data + size ? cut : cut + 1;
  scratch_file("robot.yaml", robot, static_cast<std::size_t>(data + size - robot));
  const auto file = scratch_file("site.yaml", data, static_cast<std::size_t>(cut - data));
  try {
    const Site site = load_site(file.parent_path());
    if (site.goals.empty() || !site.cameras.contains(site.default_camera)) __builtin_trap();
    if (!(site.robot.radius_m > 0.0) || !std::isfinite(site.start.yaw_rad)) __builtin_trap();
  } catch (const InputError&) {
  }
  return 0;
}
