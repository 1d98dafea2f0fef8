#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace lodestar {

struct LocalThresholdOptions {
  /// A tile whose gray values range over less holds no dots: the faintest dot stands out by so much.
  int min_range_gray = 48;
  /// And by so many times the range of a tile that shows noise alone (the frame's lower quartile), up to:
  double min_range_to_noise = 1.5;
  int max_min_range_gray = 72;  ///< in a part of a frame every tile may hold dots
};

/// From which gray value on a pixel is bright, for each tile of the frame: midway between the tile's darkest
/// and brightest pixel (Bernsen 1986), so that a dot is as large as it is whatever the light, and nothing
/// where the tile shows too little contrast. One pass over the frame.
class LocalThresholds {
 public:
  static constexpr int tile_px = 32;
  static constexpr std::uint8_t nothing_bright = 0;  ///< stands for a tile without contrast

  /// `gray` is CV_8UC1. What was found before is forgotten, its memory is used again.
  void find(const cv::Mat& gray, const LocalThresholdOptions& options);

  /// Standard deviation of a pixel's noise where nothing is bright, by the differences of neighbouring pixels
  /// in the quietest tiles.
  [[nodiscard]] double noise_gray() const { return noise_gray_; }

  /// The same threshold (1..255) everywhere, as in the paper.
  void set(const cv::Size& frame, std::uint8_t threshold);

  [[nodiscard]] int tile_rows() const { return rows_; }
  [[nodiscard]] int tile_columns() const { return columns_; }
  [[nodiscard]] std::uint8_t of_tile(int row, int column) const {
    return thresholds_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                       static_cast<std::size_t>(column)];
  }

 private:
  void resize(const cv::Size& frame);
  [[nodiscard]] double noise_in_tiles(const cv::Mat& gray, int most_range) const;

  double noise_gray_ = 0.0;
  int rows_ = 0;
  int columns_ = 0;
  std::vector<std::uint8_t> darkest_;
  std::vector<std::uint8_t> brightest_;
  std::vector<std::uint8_t> thresholds_;
};

}  // namespace lodestar
