#include "localization/detection/frame_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace lodestar {
namespace {

/// From squared differences of neighbours in short stretches of rows spread over the frame. A difference
/// cancels the ceiling's pattern and has twice a pixel's variance; dots and lamps are in the noisier
/// stretches. The lower quartile of the stretches is used: with so few differences, each of which shares its
/// pixels with the next, it is 0.79 of the mean.
double noise_along_rows(const cv::Mat& gray) {
  constexpr int stretch_px = 32;
  constexpr int most_stretches = 48;
  constexpr double quartile_to_mean = 0.79;
  const int columns = gray.cols / stretch_px;
  if (columns == 0 || gray.rows == 0) return 0.0;
  const int wanted_rows = std::max(most_stretches / columns, 1);
  const int row_step = std::max(gray.rows / wanted_rows, 1);
  const int column_step = (columns + most_stretches - 1) / most_stretches;
  std::array<int, most_stretches> squares{};
  std::size_t count = 0;
  for (int v = row_step / 2; v < gray.rows; v += row_step) {
    for (int column = 0; column < columns && count < squares.size(); column += column_step) {
      const auto* const pixels = gray.ptr<std::uint8_t>(v) + static_cast<std::ptrdiff_t>(column) * stretch_px;
      int sum = 0;
      for (int u = 0; u + 1 < stretch_px; ++u) {
        const int difference = pixels[u + 1] - pixels[u];
        sum += difference * difference;
      }
      squares[count++] = sum;
    }
  }
  auto* const quartile = squares.data() + count / 4;
  std::nth_element(squares.data(), quartile, squares.data() + count);
  return std::sqrt(*quartile / (quartile_to_mean * 2.0 * (stretch_px - 1)));
}

/// From second differences a - 2 b + c in eight directions, which have six times a pixel's variance. Slats
/// and grooves all over the frame show in every row, but hardly along themselves: the quietest direction
/// counts. The median of the differences leaves out what dots and other lines add.
double noise_along_lines(const cv::Mat& gray) {
  static const std::array<cv::Point, 8> directions{
      {{1, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 1}, {-1, 2}, {-1, 1}, {-2, 1}}};
  constexpr int reach_px = 2;
  constexpr int samples_aside = 22;
  constexpr double median_to_sigma = 0.6745;
  constexpr double quietest_of_eight = 0.92;  // to the mean of all, of so many samples of noise alone
  const double columns = gray.cols - 2.0 * reach_px;
  const double rows = gray.rows - 2.0 * reach_px;
  if (columns < samples_aside || rows < samples_aside) return std::numeric_limits<double>::infinity();
  std::array<int, samples_aside * samples_aside> sizes{};
  int least = std::numeric_limits<int>::max();
  for (const cv::Point& direction : directions) {
    std::size_t count = 0;
    const std::ptrdiff_t step = direction.y * static_cast<std::ptrdiff_t>(gray.step[0]) + direction.x;
    for (int row = 0; row < samples_aside; ++row) {
      const auto* const pixels =
          gray.ptr<std::uint8_t>(reach_px + static_cast<int>(rows * row / samples_aside));
      for (int column = 0; column < samples_aside; ++column) {
        const auto* const at = pixels + reach_px + static_cast<int>(columns * column / samples_aside);
        sizes[count++] = std::abs(at[-step] - 2 * at[0] + at[step]);
      }
    }
    auto* const median = sizes.data() + count / 2;
    std::nth_element(sizes.data(), median, sizes.data() + count);
    least = std::min(least, *median);
  }
  return least / (median_to_sigma * std::sqrt(6.0) * quietest_of_eight);
}

}  // namespace

double noise_of(const cv::Mat& gray) {
  constexpr double usual_gray = 5.0;  // more is rarely a camera's
  const double along_rows = noise_along_rows(gray);
  return along_rows < usual_gray ? along_rows : std::min(along_rows, noise_along_lines(gray));
}

}  // namespace lodestar
