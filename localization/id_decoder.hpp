#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "maps/marker.hpp"

namespace lodestar {

/// How surely each cell of a marker's grid holds a dot: the logarithm of the odds, positive for a dot, zero
/// where nothing can be said.
struct CellEvidence {
  std::array<double, static_cast<std::size_t>(marker_grid_size* marker_grid_size)> log_odds{};

  [[nodiscard]] double& at(GridCell cell) { return log_odds[index(cell)]; }
  [[nodiscard]] double at(GridCell cell) const { return log_odds[index(cell)]; }

  /// How many cells can be one or the other.
  [[nodiscard]] int undecided() const;

 private:
  static std::size_t index(GridCell cell) {
    return static_cast<std::size_t>(cell.row * marker_grid_size + cell.column);
  }
};

/// The likeliest ID of one reading of the cells.
struct IdReading {
  int id = 0;
  double cost = 0.0;        ///< log odds of the cells that contradict it
  double weight = 0.0;      ///< its likelihood times its prior
  double all_weight = 0.0;  ///< of all IDs together: weight / all_weight is the ID's posterior probability
};

/// Tells the ID from the cells' evidence by Bayes' rule. Cells err independently of each other. A registered
/// marker is expected, and which one is open; but with a small probability any of the 4096 hangs there.
class IdDecoder {
 public:
  /// No registered IDs: all are alike.
  explicit IdDecoder(std::span<const int> registered_ids = {}, double foreign_probability = 0.01);

  /// Likelihoods are relative to every cell being what its evidence says, the corners' among them: O, X and Y
  /// hold dots, the fourth does not.
  [[nodiscard]] IdReading read(const CellEvidence& cells) const;

  [[nodiscard]] bool knows_ids() const { return !ids_.empty(); }

  /// Is it one of the registered IDs, or are all alike?
  [[nodiscard]] bool accepts(int id) const;

 private:
  std::vector<int> ids_;
  double registered_prior_ = 0.0;  ///< of each registered ID
  double foreign_prior_ = 0.0;     ///< of each of all IDs
};

}  // namespace lodestar
