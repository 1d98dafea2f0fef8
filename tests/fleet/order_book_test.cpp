#include "app/fleet/order_book.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fleet/orders.hpp"

// The rules of VDA 5050 (6.6.2, figure 8), one by one. The robot stands at node n0.
namespace lodestar {
namespace {

using ::testing::Contains;

TEST(OrderBook, accepts_an_order_from_where_the_robot_stands_and_traverses_its_first_node) {
  OrderBook book(lab_options());
  book.take(order_over("a", 0, 0, 4, 3), at_start);
  EXPECT_EQ(book.order_id(), "a");
  EXPECT_EQ(book.last_node_id(), "n0");
  EXPECT_EQ(left_of(book), "n1 n2 (n3)");
  EXPECT_EQ(book.edges().size(), 3U);
  ASSERT_EQ(book.targets().size(), 2U);
  EXPECT_TRUE(book.targets()[1].rests);
}

TEST(OrderBook, rejects_an_order_that_begins_elsewhere) {
  OrderBook book(lab_options());
  book.take(order_over("a", 0, 3, 2, 2), at_start);
  EXPECT_EQ(first_error(book), vda_error::no_route);
  EXPECT_EQ(book.order_id(), "");
  EXPECT_THAT(book.errors()[0].references, Contains(ErrorReference{"nodeId", "n3"}));
  FleetOrder narrow = order_over("b", 0, 0, 2, 2);
  narrow.nodes[0].at->deviation_m = 0.05;
  book.take(narrow, Pose2{{0.1, 0.0}, 0.0});
  EXPECT_EQ(book.order_id(), "");
  narrow.nodes[0].at->deviation_m = 0.2;
  book.take(narrow, Pose2{{0.1, 0.0}, 0.0});
  EXPECT_EQ(book.order_id(), "b");
  EXPECT_TRUE(book.errors().empty());  // until an order is accepted
}

TEST(OrderBook, rejects_an_order_while_the_pose_is_unknown) {
  OrderBook book(lab_options());
  book.take(order_over("a", 0, 0, 2, 2), std::nullopt);
  EXPECT_EQ(first_error(book), vda_error::no_route);
}

TEST(OrderBook, turns_at_the_first_node_where_its_heading_asks) {
  OrderBook book(lab_options());
  FleetOrder order = order_over("a", 0, 0, 2, 2);
  order.nodes[0].at->heading_rad = 1.0;
  book.take(order, at_start);
  EXPECT_EQ(left_of(book), "n0 n1");
  ASSERT_EQ(book.targets().size(), 1U);  // a heading is taken at rest
  EXPECT_EQ(book.targets()[0].heading_rad, 1.0);
}

TEST(OrderBook, rejects_another_order_until_the_present_one_is_done) {
  OrderBook book(lab_options());
  book.take(order_over("a", 0, 0, 3, 2), at_start);
  book.reached(2);
  book.take(order_over("b", 0, 1, 2, 2), Pose2{{1.0, 0.0}, 0.0});
  EXPECT_EQ(book.order_id(), "a");  // its horizon waits
  EXPECT_EQ(first_error(book), vda_error::order);
  book.take(order_over("a", 1, 1, 1, 1), at_start);  // the horizon is withdrawn
  EXPECT_EQ(left_of(book), "");
  book.take(order_over("b", 0, 1, 2, 2), Pose2{{1.0, 0.0}, 0.0});
  EXPECT_EQ(book.order_id(), "b");
}

TEST(OrderBook, ignores_an_order_that_is_sent_again_and_rejects_an_older_one) {
  OrderBook book(lab_options());
  book.take(order_over("a", 4, 0, 3, 2), at_start);
  const std::uint64_t revision = book.revision();
  book.take(order_over("a", 4, 0, 3, 2), at_start);
  EXPECT_EQ(book.revision(), revision);
  book.take(order_over("a", 3, 1, 3, 2), at_start);
  EXPECT_EQ(first_error(book), vda_error::order_update);
}

TEST(OrderBook, stitches_an_update_to_the_last_released_node_only) {
  OrderBook book(lab_options());
  book.take(order_over("a", 0, 0, 5, 3), at_start);
  book.take(order_over("a", 1, 0, 5, 5), at_start);  // begins at the last node, not at the last released
  EXPECT_EQ(first_error(book), vda_error::order_update);
  book.take(order_over("a", 2, 3, 2, 2), at_start);  // begins in the horizon
  EXPECT_EQ(book.update_id(), 0U);
  book.take(order_over("a", 3, 2, 3, 2), at_start);
  EXPECT_EQ(left_of(book), "n1 n2 n3 (n4)");
  EXPECT_TRUE(book.errors().empty());
}

TEST(OrderBook, stitches_where_the_base_has_been_driven_to_its_end) {
  OrderBook book(lab_options());
  book.take(order_over("a", 0, 0, 3, 2), at_start);
  book.reached(2);
  EXPECT_EQ(left_of(book), "(n2)");
  EXPECT_TRUE(book.targets().empty());
  book.take(order_over("a", 1, 1, 3, 3), at_start);
  EXPECT_EQ(left_of(book), "n2 n3");
  FleetOrder same_place = order_over("a", 2, 3, 2, 2);
  same_place.nodes[0].sequence = 8;
  book.take(same_place, at_start);
  EXPECT_EQ(book.update_id(), 1U);  // the node's name alone is not enough
}

TEST(OrderBook, names_what_it_cannot_obey) {
  OrderBook book(lab_options());
  FleetOrder order = order_over("a", 0, 0, 2, 2);
  order.edges[0].demands = {"corridor"};
  book.take(order, at_start);
  EXPECT_THAT(book.errors()[0].references, Contains(ErrorReference{"parameter", "corridor"}));
  order = order_over("b", 0, 0, 2, 2);
  order.nodes[1].actions = {action("p", "pick")};
  book.take(order, at_start);
  EXPECT_THAT(book.errors()[1].references, Contains(ErrorReference{"actionType", "pick"}));
  order = order_over("c", 0, 0, 2, 2);
  order.nodes[1].at->map = "attic";
  book.take(order, at_start);
  EXPECT_EQ(book.errors().size(), 3U);
  order = order_over("d", 0, 0, 2, 2);
  order.edges[0].max_mps = 0.03;
  book.take(order, at_start);
  EXPECT_THAT(book.errors()[3].references, Contains(ErrorReference{"parameter", "maxSpeed"}));
  EXPECT_EQ(book.order_id(), "");
}

TEST(OrderBook, knows_places_by_their_names) {
  OrderBook book(lab_options());
  FleetOrder order = order_over("a", 0, 0, 2, 2);
  order.nodes[1].at.reset();
  book.take(order, at_start);
  EXPECT_EQ(first_error(book), vda_error::order);
  order.nodes[1].id = order.edges[0].to = "dock";
  book.take(order, at_start);
  ASSERT_EQ(book.targets().size(), 1U);
  EXPECT_EQ(book.targets()[0].position_m, Vec2(1.0, 1.0));
}

TEST(OrderBook, is_cleared_by_a_person_who_drives) {
  OrderBook book(lab_options());
  FleetOrder order = order_over("a", 0, 0, 3, 2);
  order.nodes[1].actions = {action("w")};
  book.take(order, at_start);
  book.set_mode(OperatingMode::manual);
  EXPECT_EQ(left_of(book), "");
  EXPECT_EQ(status_of(book, "w"), ActionStatus::failed);
  book.take(order_over("b", 0, 0, 2, 2), at_start);
  EXPECT_EQ(book.order_id(), "a");
  book.set_mode(OperatingMode::automatic);
  book.take(order_over("a", 1, 1, 2, 2), at_start);  // of an order that is no more
  EXPECT_EQ(book.update_id(), 0U);
  book.take(order_over("b", 0, 0, 2, 2), at_start);
  EXPECT_EQ(book.order_id(), "b");
}

TEST(OrderBook, keeps_an_order_whose_drive_failed_until_it_is_cancelled) {
  OrderBook book(lab_options());
  book.take(order_over("a", 0, 0, 3, 3), at_start);
  book.drive_failed("no way");
  EXPECT_TRUE(book.targets().empty());
  EXPECT_TRUE(book.is_active());
  EXPECT_EQ(book.errors()[0].level, ErrorLevel::fatal);
  book.take(InstantActions{.actions = {action("c", "cancelOrder")}}, at_start);
  book.came_to_rest();
  EXPECT_TRUE(book.errors().empty());
  EXPECT_FALSE(book.is_active());
}

}  // namespace
}  // namespace lodestar
