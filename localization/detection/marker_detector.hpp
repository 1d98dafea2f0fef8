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
  /// IDs of the registered markers. With them a marker is read whose cells cannot all be seen, when only one
  /// of them fits, and no other ID is: a marker of which something as gray as the ceiling hides dots looks
  /// just like one that hangs there unregistered. Without them every cell must be sure, and each of the 4096
  /// IDs is as likely as any other.
  std::vector<int> registered_ids;
  double least_probability = 0.99;  ///< that the ID is right; less is refused
  /// Of the 16 cells. What covers more of them is large, and cells no longer err independently of each other.
  /// IDs at distance 4 stay distinct with three lost.
  int most_undecided = 3;
  /// Where the paper's rule fails, look for any lattice of dots, of which some may be hidden. Only with
  /// registered IDs: where any may hang, each square of a lattice is somebody's.
  bool lattice_search = true;
  /// The ID by the evidence of all cells, and a probability with it. Else that of the dots found, Eq. (9),
  /// with neither.
  bool weigh_cells = true;
};

/// The paper's own way (sections 4.1 and 4.2): the threshold 200 everywhere, centres of binary dots,
/// direction dots by the farthest pair, the ID by Eq. (9), nothing else tried.
DetectorOptions paper_detection();

/// The same, with the registry's markers expected.
DetectorOptions expecting(const MarkerRegistry& registry, DetectorOptions options = {});

/// Reads the markers of frame after frame. Keeps its memory from one to the next: after the first few frames
/// it takes none.
class MarkerDetector {
 public:
  explicit MarkerDetector(const DetectorOptions& options = {});

  /// Every marker that could be decoded, the optimal one (nearest to the image centre, Eq. (1)) first. `gray`
  /// is CV_8UC1, of any size, and may be a part of a larger frame; any other type throws
  /// std::invalid_argument. The result holds until the next call.
  std::span<const DetectedMarker> detect(const cv::Mat& gray);

  /// The same for markers within these parts of the frame; beside them a marker may be missed.
  std::span<const DetectedMarker> detect_within(std::span<const cv::Rect> parts, const cv::Mat& gray);

 private:
  std::span<const DetectedMarker> read(const cv::Mat& gray, std::span<const Dot> dots);
  void append_markers_of_area(const cv::Mat& gray, std::span<const Dot> dots, std::span<const Dot> of_frame);
  void append_marker_of_lattice(const cv::Mat& gray, std::span<const Dot> dots,
                                std::span<const Dot> of_frame);
  [[nodiscard]] double confidence_of(const cv::Mat& gray, std::span<const Dot> dots) const;

  DetectorOptions options_;
  DotFinder dot_finder_;
  MarkerAreaFinder area_finder_;
  AreaReader area_reader_;
  IdDecoder id_decoder_;
  std::vector<DetectedMarker> markers_;
};

/// The markers of a single frame.
std::vector<DetectedMarker> detect_markers(const cv::Mat& gray, const DetectorOptions& options = {});

}  // namespace lodestar
