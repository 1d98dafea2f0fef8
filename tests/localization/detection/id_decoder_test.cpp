#include "localization/detection/id_decoder.hpp"

#include <array>
#include <bit>
#include <gtest/gtest.h>

namespace lodestar {
namespace {

constexpr int seen = 1766;
constexpr int with_a_dot_more = seen | 0x010;
constexpr int with_three_dots_more = seen | 0x109;

/// Evidence that surely matches this ID in every cell.
CellEvidence sure_of(int id) {
  CellEvidence cells;
  for (int row = 0; row < marker_grid_size; ++row) {
    for (int column = 0; column < marker_grid_size; ++column)
      cells.at({row, column}) = has_dot(id, {row, column}) ? 12.0 : -12.0;
  }
  return cells;
}

double probability_of(const IdReading& reading) {
  return reading.weight / reading.all_weight;
}

TEST(IdDecoder, reads_every_id_when_all_cells_are_sure) {
  const IdDecoder decoder;
  for (int id = 0; id < marker_id_count; ++id) {
    const IdReading reading = decoder.read(sure_of(id), false);
    ASSERT_EQ(reading.id, id);
    EXPECT_EQ(reading.contradicting, 0);
    EXPECT_GT(probability_of(reading), 0.99);
  }
}

// An object as gray as the ceiling may hide the dot that is not seen.
TEST(IdDecoder, believes_a_little_less_in_an_id_that_a_hidden_dot_would_make_anothers) {
  const IdReading alone = IdDecoder(std::array{seen}).read(sure_of(seen), false);
  const IdReading beside = IdDecoder(std::array{seen, with_a_dot_more}).read(sure_of(seen), false);
  EXPECT_EQ(beside.id, seen);
  EXPECT_LT(1.0 - probability_of(alone), 1e-5);
  EXPECT_GT(1.0 - probability_of(beside), 1e-4);
  EXPECT_GT(probability_of(beside), 0.999);
}

TEST(IdDecoder, no_longer_believes_it_where_a_cover_shows) {
  const IdDecoder decoder(std::array{seen, with_a_dot_more});
  EXPECT_LT(probability_of(decoder.read(sure_of(seen), true)), 0.99);
  CellEvidence one_undecided = sure_of(seen);
  one_undecided.at({3, 3}) = 0.0;
  EXPECT_LT(probability_of(decoder.read(one_undecided, false)), 0.99);
  // An occluding object does not explain a dot that is seen.
  EXPECT_GT(probability_of(decoder.read(sure_of(with_a_dot_more), true)), 0.999);
}

// If dots were lost independently of each other, three would be lost once in a hundred million frames.
TEST(IdDecoder, one_cover_hides_several_dots) {
  const IdReading reading = IdDecoder(std::array{seen, with_three_dots_more}).read(sure_of(seen), false);
  EXPECT_EQ(std::popcount(static_cast<unsigned>(seen ^ with_three_dots_more)), 3);
  EXPECT_GT(1.0 - probability_of(reading), 1e-6);
}

TEST(IdDecoder, fills_in_from_the_registry_what_is_not_seen) {
  CellEvidence cells = sure_of(with_a_dot_more);
  cells.at({1, 1}) = 0.0;
  const IdReading reading = IdDecoder(std::array{with_a_dot_more, 447}).read(cells, false);
  EXPECT_EQ(reading.id, with_a_dot_more);
  EXPECT_EQ(reading.contradicting, 0);
  EXPECT_GT(probability_of(reading), 0.99);
}

TEST(IdDecoder, tells_which_cells_contradict_an_id) {
  CellEvidence cells = sure_of(seen);
  cells.at(cell_of_o) = -12.0;
  EXPECT_EQ(IdDecoder(std::array{seen}).read(cells, false).contradicting, 1);
}

}  // namespace
}  // namespace lodestar
