#include "maps/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestar {
namespace {

/// Distances along one column, in both directions, to the nearest cell that is not drivable; outside the map
/// counts as such.
void fill_column_distances(const OccupancyMap& map, int column, std::vector<int>& distances) {
  int since = 0;  // cells since the last obstacle; the row below the map counts as one
  for (int row = 0; row < map.rows; ++row) {
    const std::size_t at = map.index({column, row});
    since = is_drivable(map.cells[at]) ? since + 1 : 0;
    distances[at] = since;
  }
  since = 0;
  for (int row = map.rows - 1; row >= 0; --row) {
    const std::size_t at = map.index({column, row});
    since = distances[at] == 0 ? 0 : since + 1;
    distances[at] = std::min(distances[at], since);
  }
}

/// The lower envelope of the parabolas (x - i)^2 + height_i^2, i = -1 .. columns (the first and the last
/// stand for the outside of the map), sampled at each column. Integer arithmetic throughout, so exact.
class RowEnvelope {
 public:
  explicit RowEnvelope(int columns)
      : columns_(columns), vertex_(static_cast<std::size_t>(columns) + 2), from_(vertex_.size()) {}

  void sample(int* row) {
    heights_.assign(static_cast<std::size_t>(columns_) + 2, 0);
    std::copy(row, row + columns_, heights_.begin() + 1);
    build();
    std::size_t top = 0;
    for (int x = 0; x < columns_; ++x) {
      while (top + 1 < count_ && from_[top + 1] <= x) ++top;
      row[x] = static_cast<int>(value(vertex_[top], x));
    }
  }

 private:
  [[nodiscard]] std::int64_t height(int i) const { return heights_[static_cast<std::size_t>(i) + 1]; }
  [[nodiscard]] std::int64_t value(int i, int x) const {
    const std::int64_t across = x - i;
    return across * across + height(i) * height(i);
  }

  /// The first column at which parabola `b` (right of `a`) lies no higher than `a`.
  [[nodiscard]] std::int64_t crossing(int a, int b) const {
    const std::int64_t ia = a;
    const std::int64_t ib = b;
    const std::int64_t above = ib * ib + height(b) * height(b) - ia * ia - height(a) * height(a);
    const std::int64_t below = 2 * (ib - ia);
    return above >= 0 ? (above + below - 1) / below : -(-above / below);
  }

  void build() {
    count_ = 0;
    for (int i = -1; i <= columns_; ++i) {
      std::int64_t from = std::numeric_limits<std::int64_t>::min();
      while (count_ > 0) {
        from = crossing(vertex_[count_ - 1], i);
        if (from > from_[count_ - 1]) break;
        --count_;
        from = std::numeric_limits<std::int64_t>::min();
      }
      vertex_[count_] = i;
      from_[count_] = from;
      ++count_;
    }
  }

  int columns_;
  std::size_t count_ = 0;
  std::vector<int> vertex_;
  std::vector<std::int64_t> from_;
  std::vector<int> heights_;
};

}  // namespace

DistanceField::DistanceField(const OccupancyMap& map)
    : columns_(map.columns), rows_(map.rows), resolution_m_(map.resolution_m), squared_(map.cells.size()) {
  for (int column = 0; column < columns_; ++column) fill_column_distances(map, column, squared_);
  RowEnvelope envelope(columns_);
  for (int row = 0; row < rows_; ++row) envelope.sample(&squared_[index({0, row})]);
}

double DistanceField::distance_m(Cell cell) const {
  return resolution_m_ * std::sqrt(static_cast<double>(squared_cells(cell)));
}

}  // namespace lodestar
