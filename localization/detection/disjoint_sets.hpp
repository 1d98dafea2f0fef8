#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace lodestar {

/// Union-find with path halving (Tarjan 1975) over `count` elements. The root of a set is its first member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count = 0) { reset(count); }

  /// Resets to `count` sets of one element each.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  /// Adds an element as a set of its own and returns its index.
  std::size_t add() {
    parent_.push_back(parent_.size());
    return parent_.size() - 1;
  }

  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(std::size_t a, std::size_t b) {
    const std::size_t root_a = root(a);
    const std::size_t root_b = root(b);
    if (root_a < root_b) {
      parent_[root_b] = root_a;
    } else {
      parent_[root_a] = root_b;
    }
  }

  /// Set number of each element; sets are numbered by their first members.
  void number(std::vector<std::size_t>& numbers) {
    numbers.resize(parent_.size());
    std::size_t sets = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      const std::size_t first = root(i);
      numbers[i] = first == i ? sets++ : numbers[first];
    }
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace lodestar
