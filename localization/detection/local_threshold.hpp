#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

namespace lodestar {

struct LocalThresholdOptions {
  /// A tile whose gray values range over less holds no dots: the faintest dot stands out by so much.
  int min_range_gray = 40;
  /// And by so many times the noise: five sigmas on either side of a tile's mean, which noise alone reaches
  /// in one tile of 2000.
  double min_range_to_noise = 10.0;
};

/// From which gray value on a pixel is bright, for each tile of the frame: midway between the tile's darkest
/// and brightest pixel (Bernsen 1986), so that a dot is as large as it is whatever the light, and nothing
/// where the tile shows too little contrast. Half a pass over the frame, and the other half where something
/// stands out.
class LocalThresholds {
 public:
  static constexpr int tile_px = 32;
  static constexpr std::uint8_t nothing_bright = 0;  ///< stands for a tile without contrast

  /// `gray` is CV_8UC1. What was found before is forgotten, its memory is used again.
  void find(const cv::Mat& gray, const LocalThresholdOptions& options);

  /// The same in the tiles that these parts of the frame touch; nothing is bright in any other.
  void find_within(std::span<const cv::Rect> parts, const cv::Mat& gray,
                   const LocalThresholdOptions& options);

  /// Standard deviation of a pixel's noise where nothing is bright, by the differences of neighbouring pixels
  /// in the quieter stretches of some rows.
  [[nodiscard]] double noise_gray() const { return noise_gray_; }

  /// The same threshold (1..255) everywhere, as in the paper.
  void set(const cv::Size& frame, std::uint8_t threshold);

  [[nodiscard]] int tile_rows() const { return rows_; }
  [[nodiscard]] int tile_columns() const { return columns_; }
  [[nodiscard]] std::uint8_t of_tile(int row, int column) const { return thresholds_[index({column, row})]; }

 private:
  void examine_tiles(const cv::Mat& gray, int row, int first, int end);
  void set_tile(const cv::Point& at, int darkest, int brightest);
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
  std::vector<std::uint8_t> ranges_;  ///< of the gray values, where something is bright
  std::vector<cv::Point> bright_tiles_;
};

}  // namespace lodestar
