#include "localization/detection/id_decoder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lodestar {
namespace {

constexpr double decisive = 3.0;  // log odds, 20 to 1

/// Log-likelihood cost of cells being the opposite of their evidence.
struct Dissent {
  double each = 0.0;   ///< sum over cells
  double cover = 0.0;  ///< one occluder explains all missing dots: maximum over cells
  int cells = 0;       ///< number of decided cells

  friend Dissent operator+(const Dissent& a, const Dissent& b) {
    return {a.each + b.each, std::max(a.cover, b.cover), a.cells + b.cells};
  }
  [[nodiscard]] double cost() const { return each + cover; }
};

/// Cost of one cell being the opposite of its evidence.
Dissent dissent_of(double log_odds, bool cover_shows, const IdDecoderOptions& options) {
  const double sureness = std::abs(log_odds);
  const int cells = sureness >= decisive ? 1 : 0;
  if (log_odds > 0.0) return {.each = sureness, .cover = 0.0, .cells = cells};
  const double each = std::min(sureness, options.covered);
  return {
      .each = each, .cover = cover_shows ? 0.0 : std::min(sureness - each, options.cover), .cells = cells};
}

/// Cost of any set of differing ID bits, tabulated in three nibbles.
class Contradiction {
 public:
  explicit Contradiction(const std::array<Dissent, 12>& of_bit) {
    for (std::size_t nibble = 0; nibble < 3; ++nibble) {
      for (unsigned bits = 1; bits < 16; ++bits) {
        const auto lowest = static_cast<std::size_t>(std::countr_zero(bits));
        of_bits_[nibble][bits] = of_bits_[nibble][bits & (bits - 1)] + of_bit[4 * nibble + lowest];
      }
    }
  }

  [[nodiscard]] Dissent of(int differing_bits) const {
    const auto bits = static_cast<unsigned>(differing_bits);
    return of_bits_[0][bits & 15U] + of_bits_[1][bits >> 4U & 15U] + of_bits_[2][bits >> 8U];
  }

 private:
  std::array<std::array<Dissent, 16>, 3> of_bits_{};
};

}  // namespace

int CellEvidence::undecided() const {
  return static_cast<int>(
      std::ranges::count_if(log_odds, [](double odds) { return std::abs(odds) < decisive; }));
}

IdDecoder::IdDecoder(std::span<const int> registered_ids, const IdDecoderOptions& options)
    : options_(options), ids_(registered_ids.begin(), registered_ids.end()) {
  const double foreign = ids_.empty() ? 1.0 : options_.foreign_probability;
  foreign_prior_ = foreign / marker_id_count;
  if (!ids_.empty()) registered_prior_ = (1.0 - foreign) / static_cast<double>(ids_.size());
}

bool IdDecoder::accepts(int id) const {
  return ids_.empty() || std::ranges::find(ids_, id) != ids_.end();
}

IdReading IdDecoder::read(const CellEvidence& cells, bool cover_shows) const {
  cover_shows = cover_shows || cells.undecided() > 0;
  int plain = 0;  // ID from the sign of each cell's evidence
  std::array<Dissent, 12> of_bit;
  Dissent of_corners;
  double all = foreign_prior_;  // times the sum over all IDs, which factors into a product over bits
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column) {
      const GridCell cell{row, column};
      const double log_odds = cells.at(cell);
      const Dissent dissent = dissent_of(log_odds, cover_shows, options_);
      const int bit = id_bit(cell);
      if (bit == 0) {
        const bool is_right = (log_odds > 0.0) == (cell != cell_always_empty);
        if (!is_right) of_corners = of_corners + dissent;
        continue;
      }
      if (log_odds > 0.0) plain |= bit;
      of_bit[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(bit)))] = dissent;
      all *= 1.0 + std::exp(-dissent.cost());
    }
  }
  const double likelihood_of_corners = std::exp(-of_corners.cost());
  IdReading reading{.id = plain,
                    .contradicting = of_corners.cells,
                    .weight = foreign_prior_ * likelihood_of_corners,
                    .all_weight = all * likelihood_of_corners};
  const Contradiction contradiction(of_bit);
  for (const int id : ids_) {
    const Dissent dissent = contradiction.of(id ^ plain) + of_corners;
    const double cost = dissent.cost();
    if (cost > 30.0) continue;
    const double likelihood = std::exp(-cost);
    const double weight = (registered_prior_ + (id == plain ? foreign_prior_ : 0.0)) * likelihood;
    reading.all_weight += registered_prior_ * likelihood;
    if (weight <= reading.weight) continue;
    reading.id = id;
    reading.contradicting = dissent.cells;
    reading.weight = weight;
  }
  return reading;
}

}  // namespace lodestar
