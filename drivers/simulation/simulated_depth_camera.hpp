#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "drivers/camera/depth_camera.hpp"
#include "drivers/simulation/moving_disc.hpp"
#include "drivers/simulation/overhang.hpp"
#include "maps/occupancy_map.hpp"
#include "maps/random.hpp"

namespace lodestar {

/// A camera of the RealSense D435 class; what the figures are from stands with them.
struct SimulatedDepthCameraOptions {
  DepthMount mount;
  double rate_hz = 15.0;
  Duration delay = std::chrono::milliseconds(50);  ///< from mid-exposure to delivery: one frame and USB
  /// Standard deviation z^2 times this: 0.08 px of disparity, 50 mm base line, 385 px focal length.
  double sigma_per_m2 = 0.004;
  double least_m = 0.28;        ///< D435 data sheet, at 640 x 480
  double unknown_share = 0.02;  ///< of the pixels, at random: dark, shiny, or matched wrongly and filtered
  int pixels_a_side =
      10;               ///< measured together: one ray for so many columns and rows, which share their depth
  double wall_m = 2.5;  ///< height of what is occupied on the map
  double person_m = 1.75;
};

/// A depth camera on the simulated robot: walls, floor, people as upright cylinders, and what hangs above the
/// floor. Equal seeds and equal drives give equal images.
class SimulatedDepthCamera final : public DepthCamera {
 public:
  SimulatedDepthCamera(const OccupancyMap& map, std::span<const Overhang> overhangs,
                       const SimulatedDepthCameraOptions& options, std::uint64_t seed);

  /// The base's true pose and all discs at `now`. Stamps ascend.
  void observe(Stamp now, const Pose2& true_map_from_base, std::span<const DiscState> discs);
  void change_map(const OccupancyMap& map) { map_ = map; }

  std::optional<DepthImage> poll() override;
  [[nodiscard]] std::string description() const override { return "simulated depth camera"; }

 private:
  struct OnItsWay {
    DepthImage image;
    Stamp arrival;
  };

  [[nodiscard]] DepthImage image_from(Stamp now, const Pose2& map_from_base,
                                      std::span<const DiscState> discs);
  [[nodiscard]] double range_m(const Vec3& from, const Vec3& way, std::span<const DiscState> discs) const;

  OccupancyMap map_;
  std::vector<Overhang> overhangs_;
  SimulatedDepthCameraOptions options_;
  Random random_;
  Stamp next_;
  Stamp now_;
  std::deque<OnItsWay> on_their_way_;
};

}  // namespace lodestar
