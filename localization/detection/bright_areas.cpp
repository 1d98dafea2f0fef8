#include "localization/detection/bright_areas.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "localization/detection/disjoint_sets.hpp"
#include "localization/detection/sixteen_pixels.hpp"

namespace lodestar {
namespace {

constexpr int tile_px = LocalThresholds::tile_px;

/// Bit i is set when pixel i of a tile's row is bright.
std::uint32_t bright_bits(const std::uint8_t* pixels, int count, std::uint8_t threshold) {
  std::uint32_t bits = 0;
  for (int i = 0; i < count; ++i) bits |= static_cast<std::uint32_t>(pixels[i] >= threshold) << i;
  return bits;
}

/// The same for several rows of a tile.
void find_bright_bits(const std::uint8_t* pixels, std::size_t stride, int count, std::uint8_t threshold,
                      std::span<std::uint32_t> rows) {
  if (count == tile_px) {
    for (std::uint32_t& bits : rows) {
      bits = bits_of(sixteen_at(pixels) >= threshold) | bits_of(sixteen_at(pixels + tile_px / 2) >= threshold)
                                                            << 16U;
      pixels += stride;
    }
    return;
  }
  for (std::uint32_t& bits : rows) {
    bits = bright_bits(pixels, count, threshold);
    pixels += stride;
  }
}

/// Starts a run where bits change from 0 to 1, and ends it where they change back or the bits end.
void append_runs(std::uint32_t bits, int left, int count, int row, std::vector<Run>& runs) {
  const bool goes_on = !runs.empty() && runs.back().row == row && runs.back().end == left;
  std::uint32_t changes = bits ^ (bits << 1U | static_cast<std::uint32_t>(goes_on));
  bool bright = goes_on;
  if (goes_on) runs.back().end = left + count;
  for (; changes != 0; changes &= changes - 1) {
    const int where = left + std::countr_zero(changes);
    if (bright) {
      runs.back().end = where;
    } else {
      runs.push_back({row, where, left + count});
    }
    bright = !bright;
  }
}

std::size_t end_of_row(std::span<const Run> runs, std::size_t first) {
  std::size_t i = first;
  while (i < runs.size() && runs[i].row == runs[first].row) ++i;
  return i;
}

/// Connected-component labelling: gives each run the label of a run above that it touches, corners included,
/// or else a new label. Labels that meet are joined.
class RowJoiner {
 public:
  RowJoiner(std::span<const Run> runs, std::vector<std::size_t>& pieces, DisjointSets& sets)
      : runs_(runs), pieces_(pieces), sets_(sets) {
    pieces_.resize(runs.size());
    sets_.reset(0);
  }

  void join_all() {
    std::size_t above = 0;
    for (std::size_t here = 0; here < runs_.size();) {
      const std::size_t here_end = end_of_row(runs_, here);
      if (here > 0 && runs_[above].row + 1 != runs_[here].row) above = here;
      join_row(above, here, here_end);
      above = here;
      here = here_end;
    }
  }

 private:
  void join_row(std::size_t above, std::size_t here, std::size_t here_end) {
    const std::size_t above_end = here;
    for (; here < here_end; ++here) {
      while (above < above_end && runs_[above].end < runs_[here].begin) ++above;
      const bool touches = above < above_end && runs_[above].begin <= runs_[here].end;
      pieces_[here] = touches ? pieces_[above] : sets_.add();
      // The last run above that it touches may also touch the next one here.
      while (above + 1 < above_end && runs_[above + 1].begin <= runs_[here].end)
        sets_.join(pieces_[here], pieces_[++above]);
    }
  }

  std::span<const Run> runs_;
  std::vector<std::size_t>& pieces_;
  DisjointSets& sets_;
};

/// Area and second moments of one area's runs. A run of n pixels from u has the sums n, n * mean and n *
/// (mean^2 + (n^2 - 1) / 12); each pixel is a square, which adds 1/12. Sums are integers: twice or twelve
/// times the value where it has halves or twelfths.
void measure(std::span<const Run> runs, BrightArea& area) {
  std::int64_t sum_2u = 0, sum_v = 0, sum_12uu = 0, sum_2uv = 0, sum_vv = 0;
  for (const Run& run : runs) {
    const std::int64_t n = run.end - run.begin;
    area.area_px += run.end - run.begin;
    const std::int64_t twice_u = run.begin + run.end - 1 - 2 * runs.front().begin;
    const std::int64_t v = run.row - runs.front().row;
    sum_2u += n * twice_u;
    sum_v += n * v;
    sum_12uu += n * (3 * twice_u * twice_u + n * n);
    sum_2uv += n * twice_u * v;
    sum_vv += n * v * v;
  }
  const double per_pixel = 1.0 / area.area_px;
  const double u = 0.5 * per_pixel * static_cast<double>(sum_2u);
  const double v = per_pixel * static_cast<double>(sum_v);
  area.mean_u_px = runs.front().begin + u;
  area.mean_v_px = runs.front().row + v;
  const double uu = per_pixel / 12.0 * static_cast<double>(sum_12uu) - u * u;
  const double uv = 0.5 * per_pixel * static_cast<double>(sum_2uv) - u * v;
  const double vv = per_pixel * static_cast<double>(sum_vv) + 1.0 / 12.0 - v * v;
  const double half_difference = std::sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv);
  const double half_sum = 0.5 * (uu + vv);
  area.aspect_ratio = std::sqrt((half_sum + half_difference) / std::max(half_sum - half_difference, 1e-9));
}

/// Component n consists of the runs of all labels with that number.
void collect_areas(std::span<const Run> runs, std::span<const std::size_t> pieces,
                   std::span<const std::size_t> numbers, BrightAreas& result) {
  result.areas.clear();
  for (const std::size_t piece : pieces) {
    const std::size_t n = numbers[piece];
    if (n == result.areas.size()) result.areas.emplace_back();
    ++result.areas[n].run_count;
  }
  std::size_t next = 0;
  for (BrightArea& area : result.areas) {
    area.first_run = next;
    next += std::exchange(area.run_count, 0);
  }
  result.runs.resize(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    BrightArea& area = result.areas[numbers[pieces[i]]];
    result.runs[area.first_run + area.run_count++] = runs[i];
  }
  for (BrightArea& area : result.areas) measure(result.runs_of(area), area);
}

/// Intersection of `a` with `b` moved down by `rows`. Both are sorted, as is the result.
void intersect(std::span<const Run> a, std::span<const Run> b, int rows, std::vector<Run>& both) {
  both.clear();
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const int row = b[j].row + rows;
    if (a[i].row == row) {
      const int begin = std::max(a[i].begin, b[j].begin);
      const int end = std::min(a[i].end, b[j].end);
      if (begin < end) both.push_back({row, begin, end});
    }
    if (std::pair(a[i].row, a[i].end) < std::pair(row, b[j].end)) {
      ++i;
    } else {
      ++j;
    }
  }
}

}  // namespace

const BrightAreas& AreaConnector::connect(std::span<const Run> runs) {
  RowJoiner(runs, pieces_, sets_).join_all();
  sets_.number(numbers_);
  collect_areas(runs, pieces_, numbers_, areas_);
  return areas_;
}

std::span<const Run> Eroder::erode(std::span<const Run> runs, int side) {
  const int reach = side / 2;
  left_.clear();
  for (const Run& run : runs) {
    if (run.end - run.begin > 2 * reach) left_.push_back({run.row, run.begin + reach, run.end - reach});
  }
  for (int rows = 1; rows <= reach; ++rows) {
    intersect(left_, runs, rows, next_);
    intersect(next_, runs, -rows, left_);
  }
  return left_;
}

const BrightAreas& BrightAreaFinder::find(const cv::Mat& gray, const LocalThresholds& thresholds) {
  find_runs(gray, thresholds);
  return connector_.connect(runs_);
}

void BrightAreaFinder::find_runs(const cv::Mat& gray, const LocalThresholds& thresholds) {
  runs_.clear();
  for (int tile_row = 0; tile_row < thresholds.tile_rows(); ++tile_row) {
    const int top = tile_row * tile_px;
    const int rows = std::min(tile_px, gray.rows - top);
    active_.clear();
    for (int column = 0; column < thresholds.tile_columns(); ++column) {
      const std::uint8_t threshold = thresholds.of_tile(tile_row, column);
      if (threshold == LocalThresholds::nothing_bright) continue;
      ActiveTile& active = active_.emplace_back();
      active.left = column * tile_px;
      active.width = std::min(tile_px, gray.cols - active.left);
      find_bright_bits(gray.ptr<std::uint8_t>(top) + active.left, gray.step[0], active.width, threshold,
                       std::span(active.bright_bits).first(static_cast<std::size_t>(rows)));
    }
    if (active_.empty()) continue;
    for (int v = 0; v < rows; ++v) {
      for (const ActiveTile& active : active_) {
        const std::uint32_t bits = active.bright_bits[static_cast<std::size_t>(v)];
        if (bits != 0) append_runs(bits, active.left, active.width, top + v, runs_);
      }
    }
  }
}

}  // namespace lodestar
