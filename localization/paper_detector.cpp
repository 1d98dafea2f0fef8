#include "localization/paper_detector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "localization/confidence.hpp"

namespace lodestar {
namespace {

using Indices = std::vector<std::size_t>;

void require_gray(const cv::Mat& gray) {
  if (!gray.empty() && gray.type() != CV_8UC1) {
    throw std::invalid_argument(
        "found a frame that is not 8-bit gray, wanted one channel of 8 bits (CV_8UC1)");
  }
}

std::vector<Dot> dots_at(const std::vector<Dot>& dots, const Indices& indices) {
  std::vector<Dot> result;
  result.reserve(indices.size());
  for (const std::size_t i : indices) result.push_back(dots[i]);
  return result;
}

double mean_of(const std::vector<Dot>& dots, double Dot::* value) {
  double sum = 0.0;
  for (const Dot& dot : dots) sum += dot.*value;
  return sum / static_cast<double>(dots.size());
}

/// Mean of the 3 x 3 pixels about a place, all of which lie in the frame.
double gray_about(const cv::Mat& gray, int u, int v) {
  int sum = 0;
  for (int j = v - 1; j <= v + 1; ++j) {
    const auto* row = gray.ptr<std::uint8_t>(j);
    sum += row[u - 1] + row[u] + row[u + 1];
  }
  return sum / 9.0;
}

bool holds_a_dot(const MarkerReading& reading, GridCell cell) {
  return std::ranges::any_of(reading.dots, [&](const MarkerDot& dot) { return dot.cell == cell; });
}

/// Is the cell wholly in the frame, and dark where the marker's film is?
bool is_empty(const cv::Mat& gray, const Vec2& center_px, double radius_px, double brightest) {
  const auto u = static_cast<int>(std::lround(center_px.x()));
  const auto v = static_cast<int>(std::lround(center_px.y()));
  const int reach = std::max(static_cast<int>(std::ceil(radius_px)), 1);
  if (u < reach || v < reach || u + reach >= gray.cols || v + reach >= gray.rows) return false;
  return gray_about(gray, u, v) < brightest;
}

/// The ID says as much by the dots it has not as by those it has: each coded cell without a dot must be seen
/// and seen dark. So a dot that is dirty, cut by the border or lost in a lamp refuses the marker.
bool empty_cells_are_dark(const cv::Mat& gray, const MarkerReading& reading, const std::vector<Dot>& dots,
                          double share_of_contrast) {
  const double radius_px = mean_of(dots, &Dot::radius_px);
  const double brightest =
      mean_of(dots, &Dot::background_gray) + share_of_contrast * mean_of(dots, &Dot::contrast_gray);
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column) {
      const GridCell cell{row, column};
      if (id_bit(cell) == 0 || holds_a_dot(reading, cell)) continue;
      if (!is_empty(gray, reading.grid.center_px(cell), radius_px, brightest)) return false;
    }
  }
  return true;
}

/// The local 'and' of dilation area and eroded image (Fig. 2d) leaves the eroded dots of this marker, whose
/// gray values Eq. (3) counts.
double confidence_of(const cv::Mat& gray, const DotImage& image, const Indices& indices) {
  GrayHistogram histogram{};
  for (const std::size_t i : indices) {
    for (const Run& run : image.eroded[i]) {
      const auto* row = gray.ptr<std::uint8_t>(run.row);
      for (int u = run.begin; u < run.end; ++u) ++histogram[row[u]];
    }
  }
  return marker_confidence(histogram);
}

Vec2 center_of(const MarkerReading& reading, GridCell cell) {
  return std::ranges::find(reading.dots, cell, &MarkerDot::cell)->center_px;
}

DetectedMarker detected(const MarkerReading& reading, double confidence) {
  DetectedMarker marker;
  marker.id = reading.id;
  marker.confidence = confidence;
  marker.o_px = center_of(reading, cell_of_o);
  marker.x_px = center_of(reading, cell_of_x);
  marker.y_px = center_of(reading, cell_of_y);
  marker.center_px = 0.5 * (marker.x_px + marker.y_px);
  marker.dots = reading.dots;
  return marker;
}

void append_markers_of_area(const cv::Mat& gray, const DotImage& image, const Indices& area,
                            const PaperDetectorOptions& options, std::vector<DetectedMarker>& markers) {
  const std::vector<Dot> dots = dots_at(image.dots, area);
  for (const MarkerReading& reading : read_area(dots, options.decoder)) {
    const std::vector<Dot> own = dots_at(dots, reading.indices);
    if (!empty_cells_are_dark(gray, reading, own, options.empty_cell_contrast)) continue;
    Indices in_frame;
    for (const std::size_t i : reading.indices) in_frame.push_back(area[i]);
    markers.push_back(detected(reading, confidence_of(gray, image, in_frame)));
  }
}

/// Eq. (1): the marker nearest to the image centre is the optimal one.
void sort_by_distance_to_center(std::vector<DetectedMarker>& markers, const cv::Size& size) {
  const Vec2 center(0.5 * (size.width - 1), 0.5 * (size.height - 1));
  std::ranges::stable_sort(markers, {},
                           [&](const DetectedMarker& marker) { return (marker.center_px - center).norm(); });
}

}  // namespace

std::vector<DetectedMarker> detect_markers(const cv::Mat& gray, const PaperDetectorOptions& options) {
  require_gray(gray);
  const DotImage image = find_dots(gray, options.dots);
  std::vector<DetectedMarker> markers;
  for (const Indices& area : dilated_areas(image.dots, options.areas)) {
    append_markers_of_area(gray, image, area, options, markers);
  }
  sort_by_distance_to_center(markers, gray.size());
  return markers;
}

}  // namespace lodestar
