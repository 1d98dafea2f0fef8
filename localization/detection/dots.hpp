#pragma once

#include <algorithm>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "localization/detection/bright_areas.hpp"
#include "localization/detection/disc_light.hpp"
#include "localization/detection/dot.hpp"
#include "localization/detection/even_ceiling.hpp"
#include "localization/detection/light_noise.hpp"
#include "localization/detection/local_threshold.hpp"
#include "localization/detection/peaks.hpp"
#include "localization/detection/touching_dots.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

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
  /// Least contrast of a dot, as a share of the contrast from which on a tile may hold one: a small blurred
  /// dot shows less of it than the tile's extremes, but specks of noise and of the ceiling's texture show
  /// less still.
  double least_contrast = 0.5;
  double min_area_px = 1.0;    ///< smaller bright areas are noise; faint small dots are 1 or 2 pixels
  double min_radius_px = 0.7;  ///< from the total light, not the bright pixels: smaller dots are hot pixels
  double max_area_px = 900.0;  ///< larger areas are tubes and lamps
  double max_aspect_ratio = 2.2;  ///< more elongated areas are tubes
  int erosion_px = 3;             ///< side of the erosion cross that separates touching dots; odd
  double flat_radius_px = 2.6;    ///< from this radius on, a dot is flat around its centre
  double tail_px = 1.7;           ///< extent of a dot's blurred edge beyond its bright pixels
  /// A ceiling that varies by this share of the dot's contrast around it is evened before the dot is
  /// measured: such a dark line on one side shifts its centre by a few hundredths of a pixel.
  double structure = 0.08;
  double most_structure = 0.5;  ///< surroundings that vary by more than this share hold other dots
  /// Share of the dot's contrast up to which light around it is the ceiling's then. A dot behind a blur of
  /// 0.9 px has 3 % of its light there.
  double least_light = 0.2;
  EdgeOptions edge;
};

/// Finds the dots of a frame: threshold, limits on area and aspect ratio, erosion of touching dots (paper,
/// section 4.1), and sub-pixel centroids. Reuses its buffers from frame to frame.
class DotFinder {
 public:
  explicit DotFinder(const DotOptions& options = {})
      : options_(options),
        light_noise_(options.shot_noise_gray_at_255),
        touching_dots_({.sampling_sigma_px2 = options.sampling_sigma_px2}) {}

  /// Omits dots cut by the frame's border. `gray` is CV_8UC1. The result is valid until the next call.
  std::span<const Dot> find(const cv::Mat& gray);

  /// Dots in and near these parts of the frame. With a fixed threshold, of the whole frame.
  std::span<const Dot> find_within(std::span<const cv::Rect> parts, const cv::Mat& gray);

  /// Standard deviation of a pixel's noise in the dark, in the last frame.
  [[nodiscard]] double noise_gray() const {
    return std::max(thresholds_.noise_gray(), options_.least_noise_gray);
  }

  /// Pixels of the dot's bright area in the last frame.
  [[nodiscard]] std::span<const Run> pixels_of(const Dot& dot) const {
    const BrightAreas& areas = area_finder_.areas();
    return areas.runs_of(areas.areas[dot.area]);
  }

 private:
  std::span<const Dot> find_by_thresholds(const cv::Mat& gray);
  void append_dots_of_area(const cv::Mat& gray, std::size_t index);
  std::span<const BrightArea> parts_of(std::span<const Run> area);
  bool append_peaks(const cv::Mat& gray, const BrightArea& area, std::size_t index, std::size_t parts);
  bool append_dot(const cv::Mat& gray, const BrightArea& area, std::size_t index);
  std::optional<Dot> measured_dot(const cv::Mat& gray, const BrightArea& area, double dark_noise_gray);

  DotOptions options_;
  LocalThresholds thresholds_;
  BrightAreaFinder area_finder_;
  Eroder eroder_;
  AreaConnector part_connector_;
  LightNoise light_noise_;
  EvenCeiling even_ceiling_;
  PeakFinder peak_finder_;
  TouchingDots touching_dots_;
  std::vector<Dot> dots_;
};

}  // namespace lodestar
