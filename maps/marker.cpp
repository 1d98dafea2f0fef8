#include "maps/marker.hpp"

namespace lodestar {

std::vector<GridCell> dots_of(int id) {
  std::vector<GridCell> cells;
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column) {
      if (has_dot(id, {row, column})) cells.push_back({row, column});
    }
  }
  return cells;
}

}  // namespace lodestar
