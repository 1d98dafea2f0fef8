#include "localization/id_decoder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lodestar {
namespace {

/// What it costs (in log likelihood) to contradict the evidence of any set of ID bits, in three nibbles.
class Contradiction {
 public:
  explicit Contradiction(const std::array<double, 12>& cost_of_bit) {
    for (std::size_t nibble = 0; nibble < 3; ++nibble) {
      for (unsigned bits = 1; bits < 16; ++bits) {
        const auto lowest = static_cast<std::size_t>(std::countr_zero(bits));
        costs_[nibble][bits] = costs_[nibble][bits & (bits - 1)] + cost_of_bit[4 * nibble + lowest];
      }
    }
  }

  [[nodiscard]] double cost(int differing_bits) const {
    const auto bits = static_cast<unsigned>(differing_bits);
    return costs_[0][bits & 15U] + costs_[1][bits >> 4U & 15U] + costs_[2][bits >> 8U];
  }

 private:
  std::array<std::array<double, 16>, 3> costs_{};
};

double cost_of_corners(const CellEvidence& cells) {
  return std::max(-cells.at(cell_of_o), 0.0) + std::max(-cells.at(cell_of_x), 0.0) +
         std::max(-cells.at(cell_of_y), 0.0) + std::max(cells.at(cell_always_empty), 0.0);
}

}  // namespace

int CellEvidence::undecided() const {
  constexpr double decisive = 3.0;  // odds of 20
  return static_cast<int>(
      std::ranges::count_if(log_odds, [](double odds) { return std::abs(odds) < decisive; }));
}

IdDecoder::IdDecoder(std::span<const int> registered_ids, double foreign_probability)
    : ids_(registered_ids.begin(), registered_ids.end()) {
  const double foreign = ids_.empty() ? 1.0 : foreign_probability;
  foreign_prior_ = foreign / marker_id_count;
  if (!ids_.empty()) registered_prior_ = (1.0 - foreign) / static_cast<double>(ids_.size());
}

bool IdDecoder::accepts(int id) const {
  return ids_.empty() || std::ranges::find(ids_, id) != ids_.end();
}

IdReading IdDecoder::read(const CellEvidence& cells) const {
  int plain = 0;  // what the evidence says bit by bit
  std::array<double, 12> cost_of_bit{};
  double all = foreign_prior_;  // times the sum over all IDs, which is a product over bits
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column) {
      const int bit = id_bit({row, column});
      if (bit == 0) continue;
      const double log_odds = cells.at({row, column});
      if (log_odds > 0.0) plain |= bit;
      const double cost = std::abs(log_odds);
      cost_of_bit[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(bit)))] = cost;
      all *= 1.0 + std::exp(-cost);
    }
  }
  IdReading reading{.id = plain, .weight = foreign_prior_, .all_weight = all};
  const Contradiction contradiction(cost_of_bit);
  for (const int id : ids_) {
    const double cost = contradiction.cost(id ^ plain);
    if (cost > 30.0) continue;
    const double likelihood = std::exp(-cost);
    const double weight = (registered_prior_ + (id == plain ? foreign_prior_ : 0.0)) * likelihood;
    reading.all_weight += registered_prior_ * likelihood;
    if (weight <= reading.weight) continue;
    reading.id = id;
    reading.cost = cost;
    reading.weight = weight;
  }
  const double cost = cost_of_corners(cells);
  reading.cost += cost;
  const double likelihood = std::exp(-cost);
  reading.weight *= likelihood;
  reading.all_weight *= likelihood;
  return reading;
}

}  // namespace lodestar
