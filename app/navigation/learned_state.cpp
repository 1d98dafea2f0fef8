#include "app/navigation/learned_state.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <span>

#include "localization/filter/registry_variance.hpp"
#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

/// Fowler, Noll and Vo: 64 bits, variant 1a.
class Fingerprint {
 public:
  void add(std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) {
      hash_ = (hash_ ^ (value & 0xffU)) * 1099511628211U;
      value >>= 8U;
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value + 0.0)); }  // no negative zero
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037U;
};

/// Added at a restart to the standard deviation of each scale, in quadrature. Assumed: 0.1 %, a tyre of 17 cm
/// that wears or is pressed by a tenth of a millimetre.
constexpr double restart_sigma = 0.001;
/// Scales beyond this are no robot's: the prior allows 2 %.
constexpr double farthest_scale = 0.2;

struct Content {
  StateOwner owner;
  LearnedState state;
};

std::uint64_t read_fingerprint(StrictYaml& yaml, const std::string& key) {
  const std::string text = yaml.text(key);
  const bool is_hex = text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!is_hex) yaml.refuse(key, "'" + text + "'", "16 hexadecimal digits");
  return std::stoull(text, nullptr, 16);
}

WheelScales read_scales(StrictYaml yaml) {
  WheelScales scales;
  constexpr std::array keys{"left", "right", "turn"};
  for (Eigen::Index i = 0; i < 3; ++i)
    scales.mean[i] =
        yaml.number(keys.at(static_cast<std::size_t>(i)), 1.0 - farthest_scale, 1.0 + farthest_scale);
  const std::vector<double> numbers = yaml.numbers("covariance", 9);
  scales.covariance = Eigen::Map<const Eigen::Matrix3d>(numbers.data());
  const bool is_possible = scales.covariance == scales.covariance.transpose() &&
                           scales.covariance.llt().info() == Eigen::Success &&
                           scales.covariance.trace() < 1.0;
  if (!is_possible)
    yaml.refuse("covariance", "no covariance of scales", "a symmetric, positive definite matrix");
  yaml.finish();
  return scales;
}

double read_registry_variance(StrictYaml& yaml) {
  constexpr auto& known = RegistryVariance::candidates;
  const double found = yaml.number("registry_variance");
  if (std::ranges::find(known, found) == known.end())
    yaml.refuse("registry_variance", fmt::format("{}", found),
                fmt::format("one of {}", fmt::join(known, ", ")));
  return found;
}

DistrustedMarker read_distrusted(StrictYaml yaml) {
  DistrustedMarker marker;
  marker.id = yaml.integer("id", 0, 4095);
  marker.offset_m = {yaml.number("x_m", -1e3, 1e3), yaml.number("y_m", -1e3, 1e3)};
  marker.turn_rad = radians(yaml.number("turn_deg", -180.0, 180.0));
  marker.fixes = yaml.integer("fixes", 1, 1'000'000'000);
  if (yaml.has("sigma_m")) marker.sigma_m = yaml.number("sigma_m", 0.0, 1e3);
  if (yaml.has("sigma_deg")) marker.sigma_rad = radians(yaml.number("sigma_deg", 0.0, 180.0));
  yaml.finish();
  return marker;
}

Content read(const fs::path& file) {
  StrictYaml yaml = StrictYaml::load(file);
  if (const std::string format = yaml.text("format"); format != "lodestar-state")
    yaml.refuse("format", "'" + format + "'", "lodestar-state");
  if (const int version = yaml.integer("version", 0, 1'000'000); version != 1)
    yaml.refuse("version", fmt::format("{}", version), "1");
  Content content;
  content.owner.robot = yaml.text("robot");
  content.owner.track_width_m = yaml.number("track_width_m");
  content.owner.wheel_step_m = yaml.number("encoder_step_m");
  content.owner.registry = read_fingerprint(yaml, "registry");
  content.owner.camera = read_fingerprint(yaml, "camera");
  content.state.wheel_scales = read_scales(yaml.mapping("wheel_scales"));
  content.state.variance_factor =
      VarianceFactor(yaml.number("variance_factor", 1.0, VarianceFactor::greatest));
  if (yaml.has("registry_variance")) content.state.registry_variance = read_registry_variance(yaml);
  for (const StrictYaml& marker : yaml.list_of_mappings("distrusted"))
    content.state.distrusted.push_back(read_distrusted(marker));
  yaml.finish();
  return content;
}

std::string text_of(const LearnedState& state, const StateOwner& owner) {
  const WheelScales& scales = state.wheel_scales;
  std::string text = fmt::format(
      "# Written by the robot while it drives. Without this file it learns anew.\n"
      "format: lodestar-state\nversion: 1\nrobot: {}\ntrack_width_m: {}\nencoder_step_m: {}\n"
      "registry: \"{:016x}\"\ncamera: \"{:016x}\"\n",
      YAML::Dump(YAML::Node(owner.robot)), owner.track_width_m, owner.wheel_step_m, owner.registry,
      owner.camera);
  text +=
      fmt::format("wheel_scales: {{left: {}, right: {}, turn: {}, covariance: [{}]}}\n", scales.mean[0],
                  scales.mean[1], scales.mean[2], fmt::join(std::span(scales.covariance.data(), 9), ", "));
  text += fmt::format("variance_factor: {}\nregistry_variance: {}\n", state.variance_factor.value(),
                      state.registry_variance);
  text += state.distrusted.empty() ? "distrusted: []\n" : "distrusted:\n";
  for (const DistrustedMarker& marker : state.distrusted)
    text +=
        fmt::format("  - {{id: {}, x_m: {}, y_m: {}, turn_deg: {}, fixes: {}, sigma_m: {}, sigma_deg: {}}}\n",
                    marker.id, marker.offset_m.x(), marker.offset_m.y(), degrees(marker.turn_rad),
                    marker.fixes, marker.sigma_m, degrees(marker.sigma_rad));
  return text;
}

std::string difference(const StateOwner& found, const StateOwner& wanted) {
  if (found.robot != wanted.robot)
    return fmt::format("it is of the robot '{}', this one is '{}'", found.robot, wanted.robot);
  if (found.track_width_m != wanted.track_width_m || found.wheel_step_m != wanted.wheel_step_m)
    return "the robot's wheels are described differently now";
  if (found.registry != wanted.registry) return "the registry of markers has changed since";
  return "the camera's calibration has changed since";
}

/// The matrix as it is read back: exactly symmetric.
WheelScales symmetric(WheelScales scales) {
  scales.covariance = (0.5 * (scales.covariance + scales.covariance.transpose())).eval();
  return scales;
}

}  // namespace

std::uint64_t fingerprint_of(const MarkerRegistry& registry) {
  Fingerprint print;
  print.add(registry.map_from_registry.position_m.x());
  print.add(registry.map_from_registry.position_m.y());
  print.add(registry.map_from_registry.yaw_rad);
  for (const RegisteredMarker& marker : registry.markers) {
    print.add(static_cast<std::uint64_t>(marker.id));
    for (const double value : marker.position_m) print.add(value);
    print.add(marker.yaw_rad);
    if (!marker.sigma) continue;
    for (const double sigma : {marker.sigma->position_m, marker.sigma->yaw_rad, marker.sigma->tilt_rad})
      print.add(sigma);
  }
  return print.value();
}

std::uint64_t fingerprint_of(const CameraModel& camera) {
  Fingerprint print;
  for (const int value : {camera.width_px, camera.height_px, static_cast<int>(camera.distortion)})
    print.add(static_cast<std::uint64_t>(value));
  for (const double value : {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px}) print.add(value);
  for (const double value : camera.coefficients) print.add(value);
  return print.value();
}

StateFile load_state(const fs::path& file, const StateOwner& owner) {
  std::error_code error;
  if (!fs::exists(file, error) && !error) return {};
  try {
    Content content = read(file);
    if (content.owner != owner)
      return {
          .state = std::nullopt,
          .warning = fmt::format("{}: not used, for {}", file.string(), difference(content.owner, owner))};
    content.state.wheel_scales.covariance.diagonal().array() += restart_sigma * restart_sigma;
    return {.state = std::move(content.state), .warning = {}};
  } catch (const std::exception& unreadable) {
    return {.state = std::nullopt, .warning = fmt::format("{}; it is not used", unreadable.what())};
  }
}

void save_state(const LearnedState& state, const StateOwner& owner, const fs::path& file) {
  LearnedState written = state;
  written.wheel_scales = symmetric(state.wheel_scales);
  write_file_atomically(file, text_of(written, owner));
}

std::vector<int> trust_again(const fs::path& file, const std::vector<int>& ids) {
  Content content = read(file);
  std::vector<int> found;
  std::erase_if(content.state.distrusted, [&](const DistrustedMarker& marker) {
    const bool is_named = std::ranges::find(ids, marker.id) != ids.end();
    if (is_named) found.push_back(marker.id);
    return is_named;
  });
  if (!found.empty()) save_state(content.state, content.owner, file);
  return found;
}

}  // namespace lodestar
