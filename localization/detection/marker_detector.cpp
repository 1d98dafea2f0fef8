#include "localization/detection/marker_detector.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <ranges>
#include <stdexcept>

#include "localization/detection/confidence.hpp"
#include "localization/detection/sixteen_pixels.hpp"
#include "maps/median.hpp"

namespace lodestar {
namespace {

using DotsOfMarker = InlineVector<Dot, MarkerDots::static_capacity>;
using DotsOfArea = InlineVector<Dot, 48>;

void require_gray(const cv::Mat& gray) {
  if (!gray.empty() && gray.type() != CV_8UC1) {
    throw std::invalid_argument(
        "found a frame that is not 8-bit gray, wanted one channel of 8 bits (CV_8UC1)");
  }
}

DotsOfMarker dots_at(std::span<const Dot> dots, const MarkerDotIndices& indices) {
  DotsOfMarker result;
  for (const std::size_t i : indices) result.push_back(dots[i]);
  return result;
}

/// `grid_place` gives the position of a direction dot that is not visible.
template <typename GridPlace>
DetectedMarker detected(int id, double probability, double confidence, const MarkerDots& dots,
                        const GridPlace& grid_place) {
  const auto place = [&](GridCell cell) -> Vec2 {
    const auto dot = std::ranges::find(dots, cell, &MarkerDot::cell);
    return dot != dots.end() ? dot->center_px : grid_place(cell);
  };
  DetectedMarker marker{.id = id, .probability = probability, .confidence = confidence};
  marker.o_px = place(cell_of_o);
  marker.x_px = place(cell_of_x);
  marker.y_px = place(cell_of_y);
  marker.center_px = 0.5 * (marker.x_px + marker.y_px);
  marker.dots = dots;
  return marker;
}

/// Eq. (1): the marker nearest to the image centre is the optimal one.
void sort_by_distance_to_center(std::vector<DetectedMarker>& markers, const cv::Size& size) {
  const Vec2 center(0.5 * (size.width - 1), 0.5 * (size.height - 1));
  std::ranges::sort(markers, {},
                    [&](const DetectedMarker& marker) { return (marker.center_px - center).squaredNorm(); });
}

/// Rejects dots of a deviating size: specular reflections, lamps, partly occluded dots.
DotsOfArea dots_of_usual_size(std::span<const Dot> dots, const MarkerDecoderOptions& options) {
  InlineVector<double, DotsOfArea::static_capacity> radii;
  for (const Dot& dot : dots) radii.push_back(dot.radius_px);
  const double usual_px = median_in_place({radii.data(), radii.size()});
  const double tolerance_px = options.alike_tolerance * usual_px + options.alike_tolerance_px2 / usual_px;
  DotsOfArea result;
  for (const Dot& dot : dots) {
    if (std::abs(dot.radius_px - usual_px) <= tolerance_px) result.push_back(dot);
  }
  return result;
}

/// Four by four places of a lattice that may hold a marker, in any of four rotations.
struct Square {
  MarkerGrid grid;  ///< without rotation: the lower left place is O
  MarkerDots dots;
  DotsOfMarker measured;
};

constexpr int quarter_turns = 4;

/// Square's cell at which a marker's cell lies when the marker is rotated by quarter turns.
GridCell turned(GridCell cell, int quarters) {
  for (int i = 0; i < quarters; ++i) cell = {cell.column, marker_grid_size - 1 - cell.row};
  return cell;
}

CellEvidence evidence_turned(const CellEvidence& square, int quarters) {
  CellEvidence marker;
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column) {
      marker.at({row, column}) = square.at(turned(GridCell{row, column}, quarters));
    }
  }
  return marker;
}

MarkerDots turned_back(MarkerDots dots, int quarters) {
  for (MarkerDot& dot : dots) dot.cell = turned(dot.cell, quarter_turns - quarters);
  return dots;
}

/// The square whose top left is this place of a lattice.
Square square_at(const DotLattice& lattice, std::span<const Dot> dots, int column, int row) {
  const auto place = [&](int c, int r) -> Vec2 {
    return lattice.origin_px + (column + c) * lattice.column_px + (row + r) * lattice.row_px;
  };
  const int last = marker_grid_size - 1;
  Square square{
      .grid = MarkerGrid(place(0, last), place(last, last), place(0, 0)), .dots = {}, .measured = {}};
  for (const LatticeDot& dot : lattice.dots) {
    const Dot& seen = dots[dot.index];
    square.dots.push_back({{dot.row - row, dot.column - column}, seen.center_px, seen.sigma_px});
    square.measured.push_back(seen);
  }
  square.grid = MarkerGrid::fitted(square.dots, square.grid);
  return square;
}

/// Calls `work` for each square that holds all of the lattice's dots.
template <typename Work>
void for_each_square(const DotLattice& lattice, std::span<const Dot> dots, const Work& work) {
  const auto [left, right] = std::ranges::minmax(lattice.dots, {}, &LatticeDot::column);
  const auto [top, bottom] = std::ranges::minmax(lattice.dots, {}, &LatticeDot::row);
  for (int column = right.column - marker_grid_size + 1; column <= left.column; ++column) {
    for (int row = bottom.row - marker_grid_size + 1; row <= top.row; ++row)
      work(square_at(lattice, dots, column, row));
  }
}

/// Number of dots that are not on the lattice but lie within the marker or right beside it.
std::size_t extra_dots_in(const Square& square, std::span<const Dot> dots) {
  const std::size_t near = dots_within(square.grid, dots);
  return near - std::min(near, square.dots.size());
}

/// Does the lattice go on right beside the square? Then it is the ceiling's, as the light between the holes
/// of a perforated plate: markers are glued on their own.
bool goes_on_beside(const Square& square, std::span<const Dot> dots, double tolerance) {
  constexpr int last = marker_grid_size - 1;
  const Vec2 origin_px = square.grid.center_px({0, 0});
  Eigen::Matrix2d px_from_places;
  px_from_places << (square.grid.center_px({0, last}) - origin_px) / last,
      (square.grid.center_px({last, 0}) - origin_px) / last;
  const Eigen::Matrix2d places_from_px = px_from_places.inverse();
  return std::ranges::any_of(dots, [&](const Dot& dot) {
    const Vec2 place = places_from_px * (dot.center_px - origin_px);
    const Vec2 whole(std::round(place.x()), std::round(place.y()));
    const bool is_inside = whole.minCoeff() >= 0.0 && whole.maxCoeff() <= last;
    const bool is_near = whole.minCoeff() >= -1.0 && whole.maxCoeff() <= last + 1;
    return is_near && !is_inside && (place - whole).norm() <= tolerance;
  });
}

/// A marker's ID, square and rotation.
struct PlacedMarker {
  Square square;
  int quarters = 0;
  IdReading id;
};

/// Some lattice fits any few dots, and any square of it reads as some ID: contradicting evidence must be
/// outweighed by supporting dots.
bool is_trusted(const PlacedMarker& marker, std::size_t extra_dots, const IdDecoder& decoder,
                const LatticeOptions& options) {
  const std::size_t dots = marker.square.dots.size();
  return decoder.accepts(marker.id.id) && marker.id.contradicting <= options.most_contradicting &&
         4 * extra_dots <= dots && (marker.id.contradicting == 0 || dots >= options.least_dots_contradicted);
}

constexpr int pixels_at_once = sizeof(SixteenPixels);

/// One bit for each of 16 pixels in a row: set where the pixel and its four neighbours are at least
/// `lowest_dot_gray`.
unsigned inner_pixels(const std::uint8_t* pixels, std::size_t stride) {
  const SixteenPixels beside = least_of(sixteen_at(pixels - 1), sixteen_at(pixels + 1));
  const SixteenPixels above_and_below = least_of(sixteen_at(pixels - stride), sixteen_at(pixels + stride));
  const SixteenPixels least = least_of(sixteen_at(pixels), least_of(beside, above_and_below));
  return bits_of(least >= static_cast<std::uint8_t>(lowest_dot_gray));
}

/// Adds the pixels of a run that remain in the paper's binary image after erosion by a cross of three. Frames
/// narrower than 18 pixels are skipped: they cannot hold a marker.
void add_inner_pixels(const cv::Mat& gray, const Run& run, ConfidenceSum& confidence) {
  if (run.row == 0 || run.row + 1 == gray.rows) return;
  const auto* const row = gray.ptr<std::uint8_t>(run.row);
  for (int u = std::max(run.begin, 1); u < run.end; u += pixels_at_once) {
    const int from = std::min(u, gray.cols - pixels_at_once - 1);
    if (from < 1) return;
    const int end = std::min({run.end, from + pixels_at_once, gray.cols - 1});
    if (end <= u) return;
    const unsigned of_run = (1U << (end - from)) - (1U << (u - from));
    for (unsigned bits = inner_pixels(row + from, gray.step[0]) & of_run; bits != 0; bits &= bits - 1)
      confidence.add(row[from + std::countr_zero(bits)]);
  }
}

}  // namespace

DetectorOptions paper_detection() {
  DetectorOptions options;
  options.dots.fixed_threshold = 200;
  options.dots.by_binary_center = true;
  options.dots.tail_px = 2.5;
  options.dots.min_radius_px = 1.3;
  options.decoder.every_corner = false;
  options.lattice_search = false;
  options.weigh_cells = false;
  return options;
}

DetectorOptions expecting(const MarkerRegistry& registry, DetectorOptions options) {
  options.registered_ids = registered_ids(registry);
  return options;
}

MarkerDetector::MarkerDetector(const DetectorOptions& options)
    : options_(options),
      dot_finder_(options.dots),
      area_finder_(options.areas),
      area_reader_(options.decoder),
      id_decoder_(options.registered_ids) {}

std::span<const DetectedMarker> MarkerDetector::detect(const cv::Mat& gray) {
  require_gray(gray);
  return read(gray, dot_finder_.find(gray));
}

std::span<const DetectedMarker> MarkerDetector::detect_within(std::span<const cv::Rect> parts,
                                                              const cv::Mat& gray) {
  require_gray(gray);
  return read(gray, dot_finder_.find_within(parts, gray));
}

std::span<const DetectedMarker> MarkerDetector::read(const cv::Mat& gray, std::span<const Dot> dots) {
  markers_.clear();
  const std::size_t areas = area_finder_.find(dots);
  for (std::size_t i = 0; i < areas; ++i) {
    const std::span<const Dot> area = bright_ones(area_finder_.dots_of(i));
    if (area.size() >= 3) append_markers_of_area(gray, area, dots);
  }
  sort_by_distance_to_center(markers_, gray.size());
  return markers_;
}

/// The area's dots without those too dim to be of the same marker.
std::span<const Dot> MarkerDetector::bright_ones(std::span<const Dot> area) {
  if (!options_.weigh_cells || area.empty()) return area;
  const auto brightness = [](const Dot& dot) { return dot.background_gray + dot.contrast_gray; };
  const double brightest = std::ranges::max(area | std::views::transform(brightness));
  const double ceiling = median_background(area);
  const double least = std::max(options_.least_brightness * brightest,
                                ceiling + options_.least_returned * (brightest - ceiling));
  if (std::ranges::all_of(area, [&](const Dot& dot) { return brightness(dot) >= least; })) return area;
  bright_dots_.clear();
  std::ranges::copy_if(area, std::back_inserter(bright_dots_),
                       [&](const Dot& dot) { return brightness(dot) >= least; });
  return bright_dots_;
}

double MarkerDetector::median_background(std::span<const Dot> area) {
  backgrounds_.clear();
  std::ranges::transform(area, std::back_inserter(backgrounds_), &Dot::background_gray);
  return median_in_place(backgrounds_);
}

void MarkerDetector::append_markers_of_area(const cv::Mat& gray, std::span<const Dot> dots,
                                            std::span<const Dot> of_frame) {
  const std::span<const MarkerReading> readings = area_reader_.read(dots);
  for (const MarkerReading& reading : readings) {
    const DotsOfMarker own = dots_at(dots, reading.indices);
    const auto grid_place = [&](GridCell cell) { return reading.grid.center_px(cell); };
    if (!options_.weigh_cells) {
      markers_.push_back(detected(reading.id, 0.0, confidence_of(gray, own), reading.dots, grid_place));
      continue;
    }
    const CellEvidence cells =
        evidence_of_cells(gray, reading.grid, reading.dots, own, dot_finder_.noise_gray(), options_.evidence);
    const bool cover_shows = shows_a_cover(reading.grid, own, of_frame, options_.evidence);
    const IdReading id = id_decoder_.read(cells, cover_shows);
    const double probability = id.weight / id.all_weight;
    if (probability < options_.least_probability || cells.undecided() > options_.most_undecided ||
        id.contradicting > 0 || !id_decoder_.accepts(id.id)) {
      continue;
    }
    markers_.push_back(detected(id.id, probability, confidence_of(gray, own), reading.dots, grid_place));
  }
  if (readings.empty() && options_.lattice_search && id_decoder_.knows_ids())
    append_marker_of_lattice(gray, dots, of_frame);
}

/// All squares and rotations of a marker on the lattice compete with each other.
void MarkerDetector::append_marker_of_lattice(const cv::Mat& gray, std::span<const Dot> dots,
                                              std::span<const Dot> of_frame) {
  if (dots.size() > DotsOfArea::static_capacity) return;
  const DotsOfArea usual = dots_of_usual_size(dots, options_.decoder);
  const std::optional<DotLattice> lattice = find_lattice(usual, options_.lattice);
  if (!lattice) return;
  std::optional<PlacedMarker> best;
  double all_weight = 0.0;
  bool is_decided = true;
  for_each_square(*lattice, usual, [&](const Square& square) {
    const CellEvidence cells = evidence_of_cells(gray, square.grid, square.dots, square.measured,
                                                 dot_finder_.noise_gray(), options_.evidence);
    const bool cover_shows = shows_a_cover(square.grid, square.measured, of_frame, options_.evidence);
    is_decided = is_decided && cells.undecided() <= options_.most_undecided;
    for (int turn = 0; turn < quarter_turns; ++turn) {
      const IdReading id = id_decoder_.read(evidence_turned(cells, turn), cover_shows);
      all_weight += id.all_weight;
      if (!best || id.weight > best->id.weight) best = PlacedMarker{square, turn, id};
    }
  });
  if (!best || !is_decided) return;  // a square with too many undecided cells may be the true one
  const double probability = best->id.weight / all_weight;
  if (probability < options_.lattice.least_probability ||
      !is_trusted(*best, extra_dots_in(best->square, dots), id_decoder_, options_.lattice) ||
      goes_on_beside(best->square, usual, options_.lattice.first_tolerance)) {
    return;
  }
  markers_.push_back(detected(best->id.id, probability, confidence_of(gray, best->square.measured),
                              turned_back(best->square.dots, best->quarters), [&](GridCell cell) {
                                return best->square.grid.center_px(turned(cell, best->quarters));
                              }));
}

/// The local 'and' of dilation area and eroded image (Fig. 2d) leaves this marker's eroded dots, whose gray
/// values enter Eq. (3). Whichever threshold found them, the paper's 200 applies here.
double MarkerDetector::confidence_of(const cv::Mat& gray, std::span<const Dot> dots) const {
  ConfidenceSum confidence;
  for (const Dot& dot : dots) {
    for (const Run& run : dot_finder_.pixels_of(dot)) add_inner_pixels(gray, run, confidence);
  }
  return confidence.value();
}

std::vector<DetectedMarker> detect_markers(const cv::Mat& gray, const DetectorOptions& options) {
  MarkerDetector detector(options);
  const std::span<const DetectedMarker> markers = detector.detect(gray);
  return {markers.begin(), markers.end()};
}

}  // namespace lodestar
