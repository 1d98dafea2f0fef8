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
  double radius_px = 0.0;        ///< of a uniform disc with the same light; blur does not change it
  double background_gray = 0.0;  ///< around the dot
  double contrast_gray = 0.0;    ///< of its middle over the background
  std::size_t area = 0;          ///< index of the bright area that it was found in
};

struct DotOptions {
  std::optional<int> fixed_threshold;  ///< gray value (1..255) from which a pixel is bright, instead of:
  LocalThresholdOptions threshold;
  bool by_binary_center = false;  ///< the paper's centre: that of the bright pixels, whatever their gray
  /// Shot noise of the sensor, standard deviation at gray 255: 255 / 4 is the root of a full well of 4000
  /// electrons. That is assumed at first, then learned; the noise in the dark is told by each frame.
  double shot_noise_gray_at_255 = 4.0;
  double least_noise_gray = 0.5;  ///< in the dark: rounding to whole gray values, and a little
  /// How far a dot's middle is off without any noise, in each coordinate: this over its radius. What pixels
  /// that sample an edge, whole gray values and a last step leave; the longer the edge, the less.
  double sampling_sigma_px2 = 0.0032;
  double min_area_px = 1.0;       ///< smaller bright areas are noise; faint small dots are a pixel or two
  double min_radius_px = 0.7;     ///< of the light, not of the bright pixels: smaller dots are hot pixels
  double max_area_px = 900.0;     ///< larger ones are tubes and lamps
  double max_aspect_ratio = 2.2;  ///< longer ones are tubes
  int erosion_px = 3;             ///< arm to arm of the cross that parts dots which touch; odd
  double flat_radius_px = 2.6;    ///< a dot so large is flat about its middle
  double tail_px = 1.7;           ///< how far a dot's blurred edge reaches beyond its bright pixels
  EdgeOptions edge;
};

/// Finds the dots of a frame: threshold, limits on area and aspect ratio, erosion where dots touch (paper,
/// section 4.1), and the dots' centres. Keeps its memory from frame to frame.
class DotFinder {
 public:
  explicit DotFinder(const DotOptions& options = {})
      : options_(options), light_noise_(options.shot_noise_gray_at_255) {}

  /// Dots that the frame's border cuts are left out. `gray` is CV_8UC1. The result holds until the next call.
  std::span<const Dot> find(const cv::Mat& gray);

  /// Dots in the neighbourhood of these parts of the frame. With a fixed threshold, of the whole frame.
  std::span<const Dot> find_within(std::span<const cv::Rect> parts, const cv::Mat& gray);

  /// The last frame's pixels of the dot's bright area.
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
