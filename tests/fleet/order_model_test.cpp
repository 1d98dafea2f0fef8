#include <gtest/gtest.h>
#include <iostream>

#include "app/fleet/order_book.hpp"
#include "maps/random.hpp"

#include "tests/fleet/orders.hpp"

// 200 streams of orders, with messages lost, doubled and out of turn, through the order book and through a
// model that was written another way: it keeps the whole chain of nodes of an order, and marks how far it is
// released and how far it is driven.
namespace lodestar {
namespace {

struct Model {
  std::string id;
  std::uint32_t update = 0;
  std::uint32_t length = 0;    ///< nodes n0 ... of the chain, with the horizon
  std::uint32_t released = 0;  ///< of them
  std::uint32_t driven = 0;    ///< of them
  std::uint32_t at = 0;        ///< the number of the node where the robot is, or was last
  bool is_cancelled = false;

  [[nodiscard]] bool is_active() const { return driven < length; }

  void take(const FleetOrder& order) {
    const std::uint32_t first = order.nodes.front().sequence / 2;
    const auto count = static_cast<std::uint32_t>(order.nodes.size());
    std::uint32_t base = 0;
    for (const FleetNode& node : order.nodes) base += node.released ? 1U : 0U;
    if (order.id == id) {
      const bool fits = order.update > update && !is_cancelled && first + 1 == released;
      if (!fits) return;
    } else {
      if (is_active() || first != at) return;
      id = order.id;
      driven = first + 1;
      is_cancelled = false;
    }
    update = order.update;
    released = first + base;
    length = first + count;
  }
  void drive() {
    if (driven >= released) return;
    at = driven++;
  }
  void cancel() {
    if (!is_active()) return;
    length = released = driven;
    is_cancelled = true;
  }
  [[nodiscard]] std::string left() const {
    std::string words;
    for (std::uint32_t i = driven; i < length; ++i)
      words += fmt::format("{}{}", words.empty() ? "" : " ",
                           i < released ? fmt::format("n{}", i) : fmt::format("(n{})", i));
    return words;
  }
};

/// What a master would send next; now and then nonsense.
FleetOrder next_order(Random& random, const Model& model, int& orders) {
  const auto count = static_cast<std::uint32_t>(1 + random.below(5));
  const auto base = static_cast<std::uint32_t>(1 + random.below(count));
  const bool is_new = !model.is_active() && random.below(3) > 0;
  const auto off = static_cast<std::uint32_t>(random.below(8) == 0 ? 1 : 0);
  if (is_new || random.below(12) == 0)
    return order_over(fmt::format("order {}", ++orders), 0, model.at + off, count, base);
  const std::uint32_t from = model.released == 0 ? 0 : model.released - 1 + off;
  return order_over(model.id, model.update + 1 - off * 2 * (model.update > 0 ? 1 : 0), from, count, base);
}

/// Orders on their way: some are lost, doubled, or overtaken by the next.
std::vector<FleetOrder> through_network(Random& random, std::vector<FleetOrder>& late, FleetOrder order) {
  std::vector<FleetOrder> arriving;
  const std::uint64_t fate = random.below(10);
  if (fate == 0) return arriving;
  if (fate == 1) {
    late.push_back(std::move(order));
    return arriving;
  }
  arriving.push_back(order);
  if (fate == 2) arriving.push_back(std::move(order));
  if (random.below(3) == 0) std::ranges::copy(late, std::back_inserter(arriving));
  if (arriving.size() > 2 || random.below(3) == 0) late.clear();
  return arriving;
}

/// Counts, so that a test of nothing fails.
struct Seen {
  int accepted = 0;
  int refused = 0;
  int cancelled = 0;
};

void run_stream(std::uint64_t seed, Seen& seen) {
  Random random(seed);
  OrderBook book(lab_options());
  Model model;
  std::vector<FleetOrder> late;
  int orders = 0;
  for (int step = 0; step < 60; ++step) {
    const std::uint64_t what = random.below(10);
    if (what < 4) {
      for (const FleetOrder& order : through_network(random, late, next_order(random, model, orders))) {
        const bool before = model.id == order.id && model.update == order.update;
        model.take(order);
        book.take(order, Pose2{{model.at, 0.0}, 0.0});
        const bool after = model.id == order.id && model.update == order.update;
        (after && !before ? seen.accepted : seen.refused) += 1;
      }
    } else if (what < 9) {
      model.drive();
      const std::vector<DriveTarget> targets = book.targets();
      if (!targets.empty()) book.reached(targets.front().sequence);
    } else if (random.below(3) == 0) {
      if (model.is_active()) ++seen.cancelled;
      model.cancel();
      book.take(InstantActions{.actions = {action(fmt::format("cancel {}", step), "cancelOrder")}}, at_start);
      book.came_to_rest();
    }
    ASSERT_EQ(left_of(book), model.left()) << "seed " << seed << ", step " << step;
    ASSERT_EQ(book.order_id(), model.id) << "seed " << seed << ", step " << step;
    ASSERT_EQ(book.update_id(), model.update) << "seed " << seed << ", step " << step;
    ASSERT_EQ(book.edges().size(), book.nodes().size()) << "seed " << seed << ", step " << step;
    ASSERT_EQ(book.is_active(), model.is_active()) << "seed " << seed << ", step " << step;
    if (!model.id.empty()) {
      ASSERT_EQ(book.last_node_id(), fmt::format("n{}", model.at)) << "seed " << seed << ", step " << step;
    }
  }
}

TEST(OrderModel, agrees_over_200_random_streams) {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) run_stream(seed, seen);
  std::cout << seen.accepted << " orders accepted, " << seen.refused << " not, " << seen.cancelled
            << " cancelled\n";
  EXPECT_GT(seen.accepted, 1000);
  EXPECT_GT(seen.refused, 500);
  EXPECT_GT(seen.cancelled, 50);
}

}  // namespace
}  // namespace lodestar
