#include "drivers/stand_in/camera_stand_in.hpp"

#include "drivers/simulation/simulated_camera.hpp"
#include "drivers/simulation/truth_socket.hpp"

namespace lodestar {
namespace {

constexpr std::size_t buffers = 4;  ///< as many as a typical camera has

class CameraStandIn final : public Camera {
 public:
  CameraStandIn(const std::string& interface, const MarkerRegistry& registry, const CameraModel& camera,
                const Eigen::Isometry3d& base_from_camera, std::uint64_t seed)
      : truth_(interface), camera_(registry, camera, base_from_camera, SimulatedCameraOptions{}, seed) {}

  std::optional<Frame> poll() override {
    while (const auto pose = truth_.poll()) {
      camera_.observe(pose->stamp, pose->map_from_base);
      has_begun_ = true;
    }
    camera_.keep_newest(buffers);
    return has_begun_ ? camera_.poll() : std::nullopt;
  }

 private:
  TruthListener truth_;
  SimulatedCamera camera_;
  bool has_begun_ = false;
};

}  // namespace

std::unique_ptr<Camera> open_camera_stand_in(const std::string& interface, const MarkerRegistry& registry,
                                             const CameraModel& camera,
                                             const Eigen::Isometry3d& base_from_camera, std::uint64_t seed) {
  return std::make_unique<CameraStandIn>(interface, registry, camera, base_from_camera, seed);
}

}  // namespace lodestar
