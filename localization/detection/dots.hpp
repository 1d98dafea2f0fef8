#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "localization/detection/bright_areas.hpp"
#include "localization/detection/disc_light.hpp"
#include "localization/detection/light_noise.hpp"
#include "localization/detection/local_threshold.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

/// One bright dot of a frame.
struct Dot {
  Vec2 center_px = Vec2::Zero();
  double sigma_px = 0.0;         ///< standard deviation of each coordinate
  double radius_px = 0.0;        ///< of a uniform disc with the same total light; independent of blur
  double background_gray = 0.0;  ///< around the dot
  double contrast_gray = 0.0;    ///< centre minus background
  std::size_t area = 0;          ///< index of its bright area
};

struct DotOptions {
  std::optional<int> fixed_threshold;  ///< global threshold (1..255) in place of the local one
  LocalThresholdOptions threshold;
  bool by_binary_center = false;  ///< the paper's centre: centroid of the bright pixels, unweighted
  /// Standard deviation of the sensor's shot noise at gray 255: 255 / 4 is the root of a full well of 4000
  /// electrons. The initial value is assumed, then learned; each frame measures its own dark noise.
  double shot_noise_gray_at_255 = 4.0;
  double least_noise_gray = 0.5;  ///< in the dark: quantization to whole gray values, and a margin
  /// Sigma of a dot's centre without noise, per coordinate, times its radius: left by pixels that sample an
  /// edge, quantization and the last Newton step. A longer edge averages more.
  double sampling_sigma_px2 = 0.0032;
  double min_area_px = 1.0;    ///< smaller bright areas are noise; faint small dots are 1 or 2 pixels
  double min_radius_px = 0.7;  ///< from the total light, not the bright pixels: smaller dots are hot pixels
  double max_area_px = 900.0;  ///< larger areas are tubes and lamps
  double max_aspect_ratio = 2.2;  ///< more elongated areas are tubes
  int erosion_px = 3;             ///< side of the erosion cross that separates touching dots; odd
  double flat_radius_px = 2.6;    ///< from this radius on, a dot is flat around its centre
  double tail_px = 1.7;           ///< extent of a dot's blurred edge beyond its bright pixels
  EdgeOptions edge;
};

/// Finds the dots of a frame: threshold, limits on area and aspect ratio, erosion of touching dots (paper,
/// section 4.1), and sub-pixel centroids. Reuses its buffers from frame to frame.
class DotFinder {
 public:
  explicit DotFinder(const DotOptions& options = {})
      : options_(options), light_noise_(options.shot_noise_gray_at_255) {}

  /// Omits dots cut by the frame's border. `gray` is CV_8UC1. The result is valid until the next call.
  std::span<const Dot> find(const cv::Mat& gray);

  /// Dots in and near these parts of the frame. With a fixed threshold, of the whole frame.
  std::span<const Dot> find_within(std::span<const cv::Rect> parts, const cv::Mat& gray);

  /// Pixels of the dot's bright area in the last frame.
  [[nodiscard]] std::span<const Run> pixels_of(const Dot& dot) const {
    const BrightAreas& areas = area_finder_.areas();
    return areas.runs_of(areas.areas[dot.area]);
  }

 private:
  std::span<const Dot> find_by_thresholds(const cv::Mat& gray);
  void append_dots_of_area(const cv::Mat& gray, std::size_t index);
  std::span<const BrightArea> parts_of(std::span<const Run> area);
  void append_dot(const cv::Mat& gray, const BrightArea& area, std::size_t index);

  DotOptions options_;
  LocalThresholds thresholds_;
  BrightAreaFinder area_finder_;
  Eroder eroder_;
  AreaConnector part_connector_;
  LightNoise light_noise_;
  std::vector<Dot> dots_;
};

}  // namespace lodestar
