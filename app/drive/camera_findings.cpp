#include "app/drive/camera_findings.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace lodestar {
namespace {

Finding look_at_rate(const Site& site, const SeenImages& seen) {
  constexpr double tolerance = 0.1;
  Finding camera{.what = "camera", .found = fmt::format("{} images in a second", seen.count)};
  const std::optional<double> rate_hz = seen.rate_hz();
  if (rate_hz) {
    camera.found += fmt::format(": {:.1f} a second by their stamps, {:.0f} ms old on arrival", *rate_hz,
                                1e3 * seen.mean_age_s());
  }
  if (!seen.description.empty()) camera.found += "; the driver claims " + seen.description;
  const std::optional<double>& wanted_hz = site.camera_settings.rate_hz;
  if (rate_hz && wanted_hz && std::abs(*rate_hz - *wanted_hz) > tolerance * *wanted_hz) {
    camera.verdict = Verdict::doubtful;
    camera.remedy = fmt::format(
        "camera_settings wants {:.4g} a second: set a shorter exposure, or plug the camera in alone on its "
        "bus",
        *wanted_hz);
  }
  return camera;
}

}  // namespace

std::vector<Finding> look_at_images(const Site& site, const SeenImages& seen) {
  if (seen.count == 0) {
    return {{.what = "camera",
             .verdict = Verdict::bad,
             .found = seen.no_camera.empty() ? "no image in a second" : seen.no_camera,
             .remedy = site.camera == "simulated" ? "start the simulated world: lodestar base --can ..."
                                                  : "plug the camera in; check its device in site.yaml"}};
  }
  Finding markers{.what = "markers", .found = fmt::format("seen: {}", fmt::join(seen.markers, " "))};
  const bool knows_one = std::ranges::any_of(seen.markers, [&](int id) {
    return std::ranges::find(site.registry.markers, id, &RegisteredMarker::id) != site.registry.markers.end();
  });
  if (!knows_one) {
    markers.verdict = Verdict::bad;
    markers.found = seen.markers.empty() ? "none seen" : markers.found + "; none of them is in the registry";
    markers.remedy = "move the robot under a marker; check the infrared light and the registry";
  }
  return {look_at_rate(site, seen), markers};
}

}  // namespace lodestar
