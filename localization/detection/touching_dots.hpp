#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "localization/detection/disjoint_sets.hpp"
#include "localization/detection/dot.hpp"
#include "localization/detection/joint_fit.hpp"
#include "maps/geometry.hpp"

namespace lodestar {

struct TouchingOptions {
  /// Dots nearer to each other than this many sigmas of their light are fitted together: they shine into each
  /// other. Sharp ones are 5.66 apart.
  double touching_sigmas = 5.1;
  double alike = 1.35;                 ///< largest ratio of their radii
  double fitted_along_sigmas = 14.0;   ///< and these along with them: a marker's other dots
  double sampling_sigma_px2 = 0.0032;  ///< as of dots measured alone
};

/// Dots that touch are fitted together, with the others about them: one marker's dots are to be measured
/// alike. Reuses its buffers.
class TouchingDots {
 public:
  explicit TouchingDots(const TouchingOptions& options = {}) : options_(options) {}

  /// Measures those of `dots` again that touch, and removes those that are none. `gray` is CV_8UC1.
  void fit(const cv::Mat& gray, double noise_gray, double variance_per_gray, std::vector<Dot>& dots);

 private:
  struct Pair {
    std::size_t a = 0;
    std::size_t b = 0;
  };

  [[nodiscard]] bool are_near(const Dot& a, const Dot& b, double sigmas) const;
  bool find_touching(std::span<const Dot> dots);
  bool find_groups(std::span<const Dot> dots);
  void fit_group(const cv::Mat& gray, double noise_gray, double variance_per_gray,
                 std::span<const std::size_t> group, std::span<Dot> dots);

  TouchingOptions options_;
  JointFit joint_fit_;
  DisjointSets groups_;
  std::vector<Pair> pairs_;             ///< that are near each other
  std::vector<std::uint8_t> touching_;  ///< 1 for a dot that touches another
  std::vector<std::size_t> numbers_;    ///< of each dot's group
  std::vector<std::size_t> order_;      ///< dots, group by group
  std::vector<Vec2> starts_px_;
  std::vector<bool> dropped_;
};

}  // namespace lodestar
