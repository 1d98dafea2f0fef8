#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/fleet/order_book.hpp"

#include "tests/fleet/orders.hpp"

// Actions of nodes and instant actions.
namespace lodestar {
namespace {

std::string begun(OrderBook& book) {
  std::string ids;
  for (const FleetAction& one : book.start_actions()) ids += one.id;
  return ids;
}

void instant(OrderBook& book, const std::string& id, const std::string& type) {
  book.take(InstantActions{.actions = {action(id, type)}}, at_start);
}

TEST(OrderActions, a_hard_one_has_the_robot_to_itself_and_soft_ones_keep_it_from_driving) {
  OrderBook book(lab_options());
  FleetOrder order = order_over("a", 0, 0, 3, 3);
  order.nodes[1].actions = {action("1", "wait", Blocking::none), action("2", "wait", Blocking::soft),
                            action("3", "wait", Blocking::hard), action("4", "wait", Blocking::none)};
  book.take(order, at_start);
  EXPECT_EQ(begun(book), "");
  ASSERT_EQ(book.targets().size(), 1U);
  EXPECT_TRUE(book.targets()[0].rests);
  book.reached(2);
  EXPECT_EQ(begun(book), "12");
  EXPECT_TRUE(book.targets().empty());
  book.action_ended("2", true);
  EXPECT_EQ(begun(book), "");  // 1 goes on
  book.action_ended("1", true);
  EXPECT_EQ(begun(book), "3");
  EXPECT_EQ(begun(book), "");
  book.action_ended("3", true);
  EXPECT_EQ(begun(book), "4");
  EXPECT_EQ(book.targets().size(), 1U);  // while 4 goes on
  EXPECT_TRUE(book.is_active());
}

TEST(OrderActions, of_a_node_that_has_been_reached_begin_when_an_update_brings_them) {
  OrderBook book(lab_options());
  book.take(order_over("a", 0, 0, 2, 2), at_start);
  book.reached(2);
  FleetOrder update = order_over("a", 1, 1, 2, 2);
  update.nodes[0].actions = {action("w")};
  book.take(update, at_start);
  EXPECT_EQ(begun(book), "w");
  EXPECT_TRUE(book.targets().empty());
}

TEST(OrderActions, that_are_unknown_fail_and_a_repeat_changes_nothing) {
  OrderBook book(lab_options());
  instant(book, "d", "dance");
  EXPECT_EQ(status_of(book, "d"), ActionStatus::failed);
  EXPECT_EQ(first_error(book), vda_error::instant_action);
  const std::uint64_t revision = book.revision();
  for (int i = 0; i < 1000; ++i) instant(book, "d", "dance");
  EXPECT_EQ(book.revision(), revision);
  EXPECT_EQ(book.actions().size(), 1U);
}

TEST(OrderActions, are_known_when_they_are_no_longer_listed) {
  OrderBook book(lab_options());
  instant(book, "s", "stateRequest");
  EXPECT_EQ(begun(book), "s");
  book.action_ended("s", true);
  book.take(order_over("a", 0, 0, 2, 2), at_start);
  EXPECT_TRUE(book.actions().empty());
  instant(book, "s", "stateRequest");
  EXPECT_TRUE(book.actions().empty());
}

TEST(OrderActions, of_a_pause_end_at_rest) {
  OrderBook book(lab_options());
  book.take(order_over("a", 0, 0, 2, 2), at_start);
  instant(book, "p", "startPause");
  EXPECT_TRUE(book.is_paused());
  EXPECT_TRUE(book.targets().empty());
  EXPECT_EQ(status_of(book, "p"), ActionStatus::running);
  book.came_to_rest();
  EXPECT_EQ(status_of(book, "p"), ActionStatus::finished);
  instant(book, "r", "stopPause");
  EXPECT_EQ(status_of(book, "r"), ActionStatus::finished);
  EXPECT_EQ(book.targets().size(), 1U);
}

TEST(OrderActions, of_a_cancelled_order_fail_and_it_is_gone_once_the_robot_stands) {
  OrderBook book(lab_options());
  FleetOrder order = order_over("a", 0, 0, 4, 3);
  order.nodes[2].actions = {action("w")};
  book.take(order, at_start);
  instant(book, "c", "cancelOrder");
  EXPECT_EQ(status_of(book, "c"), ActionStatus::running);
  EXPECT_EQ(status_of(book, "w"), ActionStatus::failed);
  EXPECT_EQ(left_of(book), "n1 n2 (n3)");
  book.take(order_over("b", 0, 0, 2, 2), at_start);
  EXPECT_EQ(book.order_id(), "a");
  book.came_to_rest();
  EXPECT_EQ(status_of(book, "c"), ActionStatus::finished);
  EXPECT_EQ(left_of(book), "");
  EXPECT_TRUE(book.edges().empty());
  EXPECT_EQ(book.order_id(), "a");
  instant(book, "c2", "cancelOrder");
  EXPECT_EQ(status_of(book, "c2"), ActionStatus::failed);
  EXPECT_EQ(book.errors().back().type, vda_error::no_order_to_cancel);
}

TEST(OrderActions, do_not_keep_a_new_order_out_while_they_are_instant) {
  OrderBook book(lab_options());
  instant(book, "i", "initPosition");
  EXPECT_EQ(begun(book), "i");
  book.take(order_over("a", 0, 0, 2, 2), at_start);
  EXPECT_EQ(book.order_id(), "a");
  EXPECT_EQ(book.actions().size(), 1U);  // it still runs
}

TEST(OrderActions, of_the_order_are_listed_before_instant_ones) {
  OrderBook book(lab_options());
  instant(book, "i", "initPosition");
  FleetOrder order = order_over("a", 0, 0, 2, 2);
  order.nodes[1].actions = {action("w")};
  book.take(order, at_start);
  EXPECT_EQ(book.actions()[0].action.id, "w");
}

TEST(OrderActions, that_never_end_do_not_pile_up) {
  OrderBook book(lab_options());
  for (int i = 0; i < 5000; ++i) instant(book, fmt::format("{}", i), i % 2 == 0 ? "initPosition" : "dance");
  EXPECT_LT(book.actions().size(), 100U);
  EXPECT_LE(book.errors().size(), 20U);
}

}  // namespace
}  // namespace lodestar
