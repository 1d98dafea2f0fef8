#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

namespace lodestar {

struct LocalThresholdOptions {
  /// A tile whose gray values range over less holds no dots: the contrast of the faintest dot.
  int min_range_gray = 40;
  /// The same limit in multiples of the noise: five sigmas on either side of a tile's mean, which noise alone
  /// reaches in one tile of 2000.
  double min_range_to_noise = 10.0;
};

/// Threshold of a bright pixel for each tile of the frame: midway between the tile's background and brightest
/// pixel (Bernsen 1986), so that a dot's size does not depend on the illumination; none where the tile has
/// too little contrast. The background is the darkest pixel, or the ceiling's brighter level where dark
/// joints or grooves cross a bright ceiling. Reads every other row, and all rows of tiles with contrast.
class LocalThresholds {
 public:
  static constexpr int tile_px = 32;
  static constexpr std::uint8_t nothing_bright = 0;  ///< marks a tile without contrast

  /// `gray` is CV_8UC1. Discards the previous result and reuses its buffers.
  void find(const cv::Mat& gray, const LocalThresholdOptions& options);

  /// The same in the tiles that these parts of the frame touch; all others are marked as without contrast.
  void find_within(std::span<const cv::Rect> parts, const cv::Mat& gray,
                   const LocalThresholdOptions& options);

  /// Standard deviation of a pixel's noise in the dark, from the differences of neighbouring pixels where and
  /// in the direction in which the ceiling is quiet: `noise_of`.
  [[nodiscard]] double noise_gray() const { return noise_gray_; }

  /// The contrast from which on a tile may hold dots in the last frame: from the options and the noise.
  [[nodiscard]] int least_range_gray() const { return least_range_; }

  /// Sets one global threshold (1..255), as in the paper.
  void set(const cv::Size& frame, std::uint8_t threshold);

  [[nodiscard]] int tile_rows() const { return rows_; }
  [[nodiscard]] int tile_columns() const { return columns_; }
  [[nodiscard]] std::uint8_t of_tile(int row, int column) const { return thresholds_[index({column, row})]; }

  /// The background in the tile of this pixel; 0 in one without contrast.
  [[nodiscard]] int background_gray(int u_px, int v_px) const {
    return backgrounds_.empty() ? 0 : backgrounds_[index({u_px / tile_px, v_px / tile_px})];
  }

  /// Do dark lines or gradients of the ceiling show in the tile of this pixel?
  [[nodiscard]] bool has_structure(int u_px, int v_px) const {
    return !structured_.empty() && structured_[index({u_px / tile_px, v_px / tile_px})] != 0;
  }

 private:
  void examine_tiles(const cv::Mat& gray, int row, int first, int end);
  void set_tile(const cv::Mat& gray, const cv::Point& at, int darkest, int brightest);
  void correct_for_neighbours(const cv::Mat& gray, const cv::Point& at);
  [[nodiscard]] std::size_t index(const cv::Point& tile) const {
    return static_cast<std::size_t>(tile.y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(tile.x);
  }

  double noise_gray_ = 0.0;
  int least_range_ = 0;
  int rows_ = 0;
  int columns_ = 0;
  std::vector<std::uint8_t> thresholds_;
  std::vector<std::uint8_t> backgrounds_;  ///< gray levels, in tiles with contrast
  std::vector<std::uint8_t> ranges_;       ///< from there to the brightest pixel
  std::vector<std::uint8_t> structured_;
  std::vector<cv::Point> bright_tiles_;
};

}  // namespace lodestar
