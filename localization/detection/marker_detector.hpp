#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "localization/detection/cell_evidence.hpp"
#include "localization/detection/detected_marker.hpp"
#include "localization/detection/dots.hpp"
#include "localization/detection/id_decoder.hpp"
#include "localization/detection/marker_areas.hpp"
#include "localization/detection/marker_decoder.hpp"
#include "localization/detection/marker_lattice.hpp"
#include "maps/marker_registry.hpp"

// From a frame to decoded markers.
namespace lodestar {

struct DetectorOptions {
  DotOptions dots;
  MarkerAreaOptions areas;
  MarkerDecoderOptions decoder;
  LatticeOptions lattice;
  CellEvidenceOptions evidence;
  /// IDs of the registered markers. With them, a marker with undecided cells is read when exactly one of them
  /// fits. Other IDs are rejected: a marker with dots behind an occluder as gray as the ceiling looks just
  /// like an unregistered one. Without them every cell must be decided, and all 4096 IDs are equally likely.
  std::vector<int> registered_ids;
  /// A marker's dots are about equally bright. One whose brightness is below this share of that of its area's
  /// brighter ones is the ceiling's: the rim of a reflector, a slat between two slots.
  double least_brightness = 0.75;
  /// Likewise of what it returns beyond the ceiling about it: on a bright ceiling the pin of a sprinkler is
  /// nearly as bright as a dot. Less than the above, as blur dims dots by unequal shares of this.
  double least_returned = 0.66;
  double least_probability = 0.99;  ///< posterior of the ID; less is rejected
  /// Limit on undecided cells of the 16. A larger occluder makes errors of cells dependent. IDs at Hamming
  /// distance 4 stay distinct with three lost.
  int most_undecided = 3;
  /// Where the paper's rule fails, search for any lattice of dots, some of which may be occluded. Only with
  /// registered IDs: if any ID were allowed, each square of a lattice would read as one.
  bool lattice_search = true;
  /// ID from the evidence of all cells, with a probability. Otherwise from the dots found, Eq. (9), without
  /// evidence or probability.
  bool weigh_cells = true;
};

/// The paper's method (sections 4.1 and 4.2): threshold 200 everywhere, centres of binary dots, direction
/// dots by the farthest pair, ID by Eq. (9), no fallback.
DetectorOptions paper_detection();

/// The given options, with the registry's IDs as registered IDs.
DetectorOptions expecting(const MarkerRegistry& registry, DetectorOptions options = {});

/// Detects the markers of frame after frame. Reuses its buffers: allocates nothing after the first few
/// frames.
class MarkerDetector {
 public:
  explicit MarkerDetector(const DetectorOptions& options = {});

  /// All markers that could be decoded, the optimal one (nearest to the image centre, Eq. (1)) first. `gray`
  /// is CV_8UC1, of any size, and may be a region of a larger frame; any other type throws
  /// std::invalid_argument. The result is valid until the next call.
  std::span<const DetectedMarker> detect(const cv::Mat& gray);

  /// The same within these parts of the frame; markers outside them may be missed.
  std::span<const DetectedMarker> detect_within(std::span<const cv::Rect> parts, const cv::Mat& gray);

 private:
  std::span<const DetectedMarker> read(const cv::Mat& gray, std::span<const Dot> dots);
  std::span<const Dot> bright_ones(std::span<const Dot> area);
  double median_background(std::span<const Dot> area);
  void append_markers_of_area(const cv::Mat& gray, std::span<const Dot> dots, std::span<const Dot> of_frame);
  void append_marker_of_lattice(const cv::Mat& gray, std::span<const Dot> dots,
                                std::span<const Dot> of_frame);
  [[nodiscard]] double confidence_of(const cv::Mat& gray, std::span<const Dot> dots) const;

  DetectorOptions options_;
  DotFinder dot_finder_;
  MarkerAreaFinder area_finder_;
  AreaReader area_reader_;
  IdDecoder id_decoder_;
  std::vector<Dot> bright_dots_;  ///< of an area that has others too
  std::vector<double> backgrounds_;
  std::vector<DetectedMarker> markers_;
};

/// The markers of a single frame.
std::vector<DetectedMarker> detect_markers(const cv::Mat& gray, const DetectorOptions& options = {});

}  // namespace lodestar
