#include "maps/marker_code.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <utility>

#include "maps/random.hpp"

namespace lodestar {
namespace {

using IdSet = std::bitset<marker_id_count>;

constexpr int id_bits = 12;
constexpr int last = marker_grid_size - 1;

/// All views but the upright one.
constexpr std::array<MarkerView, 7> other_views{
    {{1, false}, {2, false}, {3, false}, {0, true}, {1, true}, {2, true}, {3, true}}};

GridCell seen_at(GridCell cell, MarkerView view) {
  if (view.mirrored) cell = {last - cell.column, last - cell.row};
  for (int turn = 0; turn < view.quarter_turns; ++turn) cell = {last - cell.column, cell.row};
  return cell;
}

int cells_apart(MarkerPattern a, MarkerPattern b) {
  return std::popcount(static_cast<unsigned>(a ^ b));
}

/// The patterns of all IDs, worked out once.
struct Patterns {
  std::vector<MarkerPattern> upright;
  std::array<std::vector<MarkerPattern>, other_views.size()> turned;  ///< in each of the other views
};

const Patterns& patterns() {
  static const Patterns all = [] {
    Patterns patterns;
    for (int id = 0; id < marker_id_count; ++id) {
      patterns.upright.push_back(pattern_of(id));
      for (std::size_t i = 0; i < other_views.size(); ++i)
        patterns.turned[i].push_back(pattern_of(id, other_views[i]));
    }
    return patterns;
  }();
  return all;
}

/// For each ID the IDs that must not be chosen together with it; contains the ID itself when it must not be
/// chosen at all.
class Rivals {
 public:
  explicit Rivals(const MarkerCodeOptions& options) : options_(options), of_(marker_id_count) {
    for (int id = 0; id < marker_id_count; ++id) add_rivals_from(id);
  }

  const IdSet& operator[](int id) const { return of_[static_cast<std::size_t>(id)]; }

 private:
  /// The relation is symmetric, since for each view its inverse counts too.
  void add_rivals_from(int a) {
    const auto place_of_a = static_cast<std::size_t>(a);
    const std::vector<MarkerPattern>& upright = patterns().upright;
    for (int b = 0; b <= a; ++b) {
      const auto place_of_b = static_cast<std::size_t>(b);
      const bool are_near =
          a != b && cells_apart(upright[place_of_a], upright[place_of_b]) < options_.min_distance;
      const bool rivals = are_near || (options_.all_views && turned_distance(a, b) < options_.min_distance);
      if (!rivals) continue;
      of_[place_of_a].set(place_of_b);
      of_[place_of_b].set(place_of_a);
    }
  }

  MarkerCodeOptions options_;
  std::vector<IdSet> of_;
};

/// The IDs that are candidates at all.
IdSet candidates(const std::vector<int>& taken, const Rivals& rivals, const MarkerCodeOptions& options) {
  IdSet free;
  for (int id = 0; id < marker_id_count; ++id) {
    const bool allowed =
        cells_apart(pattern_of(id), 0) >= options.min_dots && !rivals[id][static_cast<std::size_t>(id)];
    free.set(static_cast<std::size_t>(id), allowed);
  }
  for (const int id : taken) {
    free &= ~rivals[id];
    free.reset(static_cast<std::size_t>(id));
  }
  return free;
}

/// An order of all IDs: the sums (XOR) of basis words, those with the last word at the end, each with the
/// constant added.
struct Order {
  std::array<int, id_bits> basis{};
  int constant = 0;
};

/// Gaussian elimination over GF(2).
bool is_basis(std::array<int, id_bits> words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == 0) return false;
    const int lead = static_cast<int>(std::bit_floor(static_cast<unsigned>(words[i])));
    for (std::size_t j = i + 1; j < words.size(); ++j) {
      if ((words[j] & lead) != 0) words[j] ^= words[i];
    }
  }
  return true;
}

int random_id(Random& random) {
  return static_cast<int>(random.below(marker_id_count));
}

Order random_order(Random& random) {
  Order order;
  for (std::size_t i = 0; i < id_bits; ++i) {
    order.basis[i] = 1 << i;
    std::swap(order.basis[i], order.basis[random.below(i + 1)]);
  }
  order.constant = random_id(random);
  return order;
}

/// A neighbour in the search: another constant, or one basis word changed or moved.
Order varied(const Order& order, Random& random) {
  for (;;) {
    Order result = order;
    int& word = result.basis[random.below(id_bits)];
    int& other = result.basis[random.below(id_bits)];
    switch (random.below(4)) {
      case 0:
        result.constant = random_id(random);
        break;
      case 1:
        std::swap(word, other);
        break;
      case 2:
        word ^= other;
        break;
      default:
        word = random_id(random);
    }
    if (is_basis(result.basis)) return result;
  }
}

std::vector<int> ids_in(const Order& order) {
  std::vector<int> ids{order.constant};
  ids.reserve(marker_id_count);
  for (const int word : order.basis) {
    const std::size_t so_far = ids.size();
    for (std::size_t i = 0; i < so_far; ++i) ids.push_back(ids[i] ^ word);
  }
  return ids;
}

std::vector<int> lexicode(const Order& order, IdSet free, const Rivals& rivals, std::size_t count) {
  std::vector<int> code;
  for (const int id : ids_in(order)) {
    if (!free[static_cast<std::size_t>(id)]) continue;
    code.push_back(id);
    if (code.size() == count) break;
    free &= ~rivals[id];
    free.reset(static_cast<std::size_t>(id));
  }
  return code;
}

}  // namespace

MarkerPattern pattern_of(int id, MarkerView view) {
  unsigned pattern = 0;
  for (const GridCell cell : dots_of(id)) {
    const GridCell place = seen_at(cell, view);
    pattern |= 1U << static_cast<unsigned>(marker_grid_size * place.row + place.column);
  }
  return static_cast<MarkerPattern>(pattern);
}

int id_distance(int a, int b) {
  return std::popcount(static_cast<unsigned>(a ^ b));
}

int turned_distance(int a, int b) {
  int least = marker_grid_size * marker_grid_size;
  const MarkerPattern upright = patterns().upright[static_cast<std::size_t>(a)];
  for (const std::vector<MarkerPattern>& turned : patterns().turned)
    least = std::min(least, cells_apart(upright, turned[static_cast<std::size_t>(b)]));
  return least;
}

bool is_turned(int a, int b) {
  const MarkerPattern upright = patterns().upright[static_cast<std::size_t>(a)];
  return std::ranges::any_of(patterns().turned, [&](const std::vector<MarkerPattern>& turned) {
    return turned[static_cast<std::size_t>(b)] == upright;
  });
}

std::vector<int> choose_marker_ids(int count, const std::vector<int>& taken,
                                   const MarkerCodeOptions& options) {
  const auto wanted = static_cast<std::size_t>(std::max(count, 0));
  if (wanted == 0) return {};
  const Rivals rivals(options);
  const IdSet free = candidates(taken, rivals, options);
  Random random(options.seed);
  constexpr int patience = 300;  // steps without a larger code before a restart
  std::vector<int> best;
  Order order;
  std::size_t size = 0;
  int waited = patience;
  for (int i = 0; i < options.lexicodes && best.size() < wanted; ++i) {
    const bool afresh = waited >= patience;
    const Order next = afresh ? random_order(random) : varied(order, random);
    std::vector<int> code = lexicode(next, free, rivals, wanted);
    waited = afresh || code.size() > size ? 0 : waited + 1;
    if (afresh || code.size() >= size) {
      order = next;
      size = code.size();
    }
    if (code.size() > best.size()) best = std::move(code);
  }
  std::ranges::sort(best);
  return best;
}

std::vector<int> choose_marker_ids(int count, const std::vector<int>& taken) {
  constexpr std::array<MarkerCodeOptions, 3> codes{
      {{.min_distance = 3, .lexicodes = 500},
       {.min_distance = 3, .all_views = false, .lexicodes = 500},
       {.min_distance = 2, .all_views = false, .lexicodes = 500}}};
  std::vector<int> ids;
  for (const MarkerCodeOptions& code : codes) {
    ids = choose_marker_ids(count, taken, code);
    if (std::ssize(ids) >= count) break;
  }
  return ids;
}

}  // namespace lodestar
