#include "maps/obstacle_field.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace lodestar {
namespace {

constexpr std::uint16_t far_height = 256;  ///< its square is beyond what is stored

/// The lower envelope of the parabolas (x - i)^2 + height_i^2, i = -1 .. columns (the first and the last
/// stand for the outside of the map), sampled at each column.
class Envelope {
 public:
  explicit Envelope(int columns) : columns_(columns), sites_(static_cast<std::size_t>(columns) + 2) {}

  /// From heights to squared distances.
  void sample(std::uint16_t* row) {
    count_ = 0;
    add(-1, 0);
    for (int i = 0; i < columns_; ++i)
      if (row[i] < far_height) add(i, row[i]);
    add(columns_, 0);
    std::size_t top = 0;
    for (int x = 0; x < columns_; ++x) {
      while (top + 1 < count_ && sites_[top + 1].from <= x) ++top;
      const std::int64_t across = x - sites_[top].column;
      const std::int64_t squared = across * across + sites_[top].squared_height;
      row[x] = static_cast<std::uint16_t>(std::min<std::int64_t>(squared, ObstacleField::far));
    }
  }

 private:
  struct Site {
    int column = 0;
    int squared_height = 0;
    std::int64_t from = 0;  ///< the first column at which it is lowest
  };

  /// The first column at which the parabola of `b`, right of `a`, lies no higher.
  static std::int64_t crossing(const Site& a, int column, int squared_height) {
    const std::int64_t apart = column - a.column;
    const std::int64_t above =
        apart * (static_cast<std::int64_t>(column) + a.column) + squared_height - a.squared_height;
    const std::int64_t below = 2 * apart;
    return above >= 0 ? (above + below - 1) / below : -(-above / below);
  }

  void add(int column, int height) {
    std::int64_t from = std::numeric_limits<std::int64_t>::min();
    while (count_ > 0) {
      from = crossing(sites_[count_ - 1], column, height * height);
      if (from > sites_[count_ - 1].from) break;
      --count_;
      from = std::numeric_limits<std::int64_t>::min();
    }
    sites_[count_++] = {column, height * height, from};
  }

  int columns_;
  std::size_t count_ = 0;
  std::vector<Site> sites_;
};

/// Of a matrix of 64 x 64 bits: swaps the quarters that lie off the diagonal, then those of each quarter,
/// down to single bits (Warren, Hacker's Delight, 7-3).
void transpose(std::array<std::uint64_t, 64>& rows) {
  std::uint64_t low_half = 0xffffffff;
  for (std::size_t width = 32; width > 0; width /= 2, low_half ^= low_half << width) {
    for (std::size_t row = 0; row < rows.size(); row = (row + width + 1) & ~width) {
      std::uint64_t& upper = rows[row];
      std::uint64_t& lower = rows[row + width];
      const std::uint64_t differ = (upper >> width ^ lower) & low_half;
      upper ^= differ << width;
      lower ^= differ;
    }
  }
}

}  // namespace

ObstacleField::ObstacleField(OccupancyMap map)
    : map_(std::move(map)),
      words_a_row_((static_cast<std::size_t>(map_.columns) + 63U) / 64U),
      obstacles_(words_a_row_ * static_cast<std::size_t>(map_.rows), 0),
      words_a_column_((static_cast<std::size_t>(map_.rows) + 63U) / 64U),
      by_column_(words_a_column_ * static_cast<std::size_t>(map_.columns), 0),
      squared_(map_.cells.size()) {
  mark_obstacles();
  mark_by_column();
  measure_columns();
  measure_rows();
}

void ObstacleField::mark_obstacles() {
  const auto columns = static_cast<std::size_t>(map_.columns);
  for (std::size_t row = 0; row < static_cast<std::size_t>(map_.rows); ++row) {
    const std::int8_t* const cells = &map_.cells[row * columns];
    for (std::size_t column = 0; column < columns; ++column)
      obstacles_[row * words_a_row_ + column / 64U] |= static_cast<std::uint64_t>(!is_drivable(cells[column]))
                                                       << (column % 64U);
  }
}

void ObstacleField::mark_by_column() {
  const auto columns = static_cast<std::size_t>(map_.columns);
  const auto rows = static_cast<std::size_t>(map_.rows);
  for (std::size_t i = 0; i < words_a_row_; ++i) {
    for (std::size_t k = 0; k < words_a_column_; ++k) {
      std::array<std::uint64_t, 64> block{};
      for (std::size_t row = 64 * k; row < std::min(64 * k + 64, rows); ++row)
        block[row % 64] = obstacles_[row * words_a_row_ + i];
      transpose(block);
      for (std::size_t column = 64 * i; column < std::min(64 * i + 64, columns); ++column)
        by_column_[column * words_a_column_ + k] = block[column % 64];
    }
  }
}

/// Heights: distances along each column, row by row, upwards and downwards.
void ObstacleField::measure_columns() {
  const auto columns = static_cast<std::size_t>(map_.columns);
  const auto rows = static_cast<std::size_t>(map_.rows);
  const std::vector<std::uint16_t> outside(columns, 0);
  const auto one_more = [](std::uint16_t height) {
    return static_cast<std::uint16_t>(std::min<int>(height + 1, far_height));
  };
  for (std::size_t row = 0; row < rows; ++row) {
    const std::int8_t* const cells = &map_.cells[row * columns];
    std::uint16_t* const heights = &squared_[row * columns];
    const std::uint16_t* const below = row == 0 ? outside.data() : heights - columns;
    for (std::size_t i = 0; i < columns; ++i)
      heights[i] = is_drivable(cells[i]) ? one_more(below[i]) : std::uint16_t{0};
  }
  for (std::size_t row = rows; row-- > 0;) {
    std::uint16_t* const heights = &squared_[row * columns];
    const std::uint16_t* const above = row + 1 == rows ? outside.data() : heights + columns;
    for (std::size_t i = 0; i < columns; ++i) heights[i] = std::min(heights[i], one_more(above[i]));
  }
}

void ObstacleField::measure_rows() {
  Envelope envelope(map_.columns);
  for (int row = 0; row < map_.rows; ++row) envelope.sample(&squared_[map_.index({0, row})]);
}

}  // namespace lodestar
