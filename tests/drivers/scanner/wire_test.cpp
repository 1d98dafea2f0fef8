#include <gtest/gtest.h>

#include "maps/geometry.hpp"

#include "tests/drivers/scanner/dialogue.hpp"

namespace lodestar {
namespace {

/// The example of the LD19 development manual, as its bytes say (its table says B0 for an intensity of C0).
const Bytes ld19_example{0x54, 0x2C, 0x68, 0x08, 0xAB, 0x7E, 0xE0, 0x00, 0xE4, 0xDC, 0x00, 0xE2,
                         0xD9, 0x00, 0xE5, 0xD5, 0x00, 0xE3, 0xD3, 0x00, 0xE4, 0xD0, 0x00, 0xE9,
                         0xCD, 0x00, 0xE4, 0xCA, 0x00, 0xE2, 0xC7, 0x00, 0xE9, 0xC5, 0x00, 0xE5,
                         0xC2, 0x00, 0xE5, 0xC0, 0x00, 0xE5, 0xBE, 0x82, 0x3A, 0x1A, 0x50};

TEST(Ld19Wire, reads_the_example_of_the_manual) {
  const std::optional<ld19::Packet> packet = ld19::decode(ld19_example);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->speed_degps, 2152);
  EXPECT_EQ(packet->start_cdeg, 32427);
  EXPECT_EQ(packet->points[0].distance_mm, 224);
  EXPECT_EQ(packet->points[0].intensity, 228);
  EXPECT_EQ(packet->points[11].distance_mm, 192);
  EXPECT_EQ(packet->end_cdeg, 33470);
  EXPECT_EQ(packet->time_ms, 6714);
  EXPECT_EQ(ld19::encode(*packet), ld19_example);
}

TEST(Ld19Wire, notices_each_corrupted_byte) {
  for (std::size_t at = 0; at < ld19_example.size(); ++at) {
    for (unsigned flips = 1; flips < 256; ++flips) {
      Bytes corrupted = ld19_example;
      corrupted[at] ^= static_cast<std::uint8_t>(flips);
      ASSERT_FALSE(ld19::decode(corrupted)) << at << " " << flips;
    }
  }
}

TEST(RplidarWire, writes_requests_as_the_application_notes_do) {
  using rplidar::Command;
  EXPECT_EQ(rplidar::encode({Command::scan, {}}), (Bytes{0xA5, 0x20}));
  // Express scan: A5 82 05 00 00 00 00 00 22.
  EXPECT_EQ(rplidar::encode({Command::express_scan, Bytes(5)}),
            (Bytes{0xA5, 0x82, 0x05, 0, 0, 0, 0, 0, 0x22}));
}

TEST(RplidarWire, reads_descriptors_as_the_application_notes_write_them) {
  const auto scan = rplidar::decode_descriptor(Bytes{0xA5, 0x5A, 0x05, 0x00, 0x00, 0x40, 0x81});
  ASSERT_TRUE(scan);
  EXPECT_TRUE(scan->is_stream);
  EXPECT_EQ(scan->size, 5U);
  EXPECT_EQ(scan->answer, rplidar::Answer::nodes);
  const auto info = rplidar::decode_descriptor(Bytes{0xA5, 0x5A, 0x14, 0x00, 0x00, 0x00, 0x04});
  ASSERT_TRUE(info);
  EXPECT_FALSE(info->is_stream);
  EXPECT_EQ(info->size, 20U);
}

TEST(RplidarWire, reads_a_node) {
  // Quality 15, first of its turn; 90 degrees is 5760 / 64; 1000.25 mm is 4001 / 4.
  const std::optional<rplidar::Node> node = rplidar::decode_node(Bytes{0x3D, 0x01, 0x2D, 0xA1, 0x0F});
  ASSERT_TRUE(node);
  EXPECT_TRUE(node->begins_turn);
  EXPECT_EQ(node->quality, 15);
  EXPECT_EQ(node->angle_q6, 90 * 64);
  EXPECT_EQ(node->distance_q2, 4001);
  EXPECT_FALSE(rplidar::decode_node(Bytes{0x3F, 0x01, 0x2D, 0xA1, 0x0F})) << "both S and not S";
  EXPECT_FALSE(rplidar::decode_node(Bytes{0x3D, 0x00, 0x2D, 0xA1, 0x0F})) << "check bit";
}

TEST(RplidarWire, notices_each_corrupted_byte_of_a_capsule) {
  Random random(4);
  rplidar::Capsule capsule{.start_q6 = 12345};
  for (std::size_t i = 0; i < rplidar::express_points; ++i) {
    capsule.distance_mm[i] = static_cast<std::uint16_t>(random.below(1U << 14U));
    capsule.back_q3[i] = static_cast<std::uint8_t>(random.below(64));
  }
  const Bytes bytes = rplidar::encode_express(capsule);
  ASSERT_EQ(rplidar::decode_capsule(bytes, rplidar::Answer::express), capsule);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (unsigned flips = 1; flips < 256; ++flips) {
      Bytes corrupted = bytes;
      corrupted[at] ^= static_cast<std::uint8_t>(flips);
      ASSERT_FALSE(rplidar::decode_capsule(corrupted, rplidar::Answer::express)) << at << " " << flips;
    }
  }
}

TEST(ScipWire, codes_numbers_as_the_specification_does) {
  // SCIP 2.0 specification: 1234 in two characters is "CB", 5432 in three "1Dh".
  EXPECT_EQ(scip::encode_number(1234, 2), "CB");
  EXPECT_EQ(scip::encode_number(5432, 3), "1Dh");
  EXPECT_EQ(scip::decode_number("1Dh"), 5432U);
  EXPECT_EQ(scip::decode_number("CB"), 1234U);
  EXPECT_FALSE(scip::decode_number("1 h"));
}

TEST(ScipWire, signs_lines_as_the_specification_does) {
  // The status lines of every answer: "00P" and "99b".
  EXPECT_EQ(scip::checksum("00"), 'P');
  EXPECT_EQ(scip::checksum("99"), 'b');
}

TEST(ScipWire, refuses_impossible_parameters) {
  scip::Parameters parameters{.min_range_mm = 20,
                              .max_range_mm = 4095,
                              .steps_per_turn = 1024,
                              .first_step = 44,
                              .last_step = 725,
                              .front_step = 384,
                              .turns_per_minute = 600};
  ASSERT_TRUE(scip::parameters_of(scip::lines_of(parameters)));
  EXPECT_EQ(scip::order_to_scan(parameters), "MD0044072501000");
  parameters.last_step = 30;
  EXPECT_FALSE(scip::parameters_of(scip::lines_of(parameters)));
}

TEST(NanoscanWire, reads_fragments_in_any_order_and_refuses_what_does_not_fit) {
  nanoscan::Telegram telegram{.scan_number = 7, .scan_time_ms = 40, .angle_step = 1 << 20U};
  telegram.points.assign(1651, {1234, 200, nanoscan::valid});
  std::vector<Bytes> fragments = nanoscan::fragments_of(nanoscan::encode(telegram), 5);
  ASSERT_EQ(fragments.size(), 5U);
  Bytes whole(nanoscan::encode(telegram).size());
  for (const Bytes& bytes : fragments) {
    const auto fragment = nanoscan::decode_fragment(bytes);
    ASSERT_TRUE(fragment);
    std::ranges::copy(fragment->payload, whole.begin() + fragment->offset);
  }
  EXPECT_EQ(nanoscan::decode_telegram(whole), telegram);
  fragments[1][16] ^= 0xFFU;  // its offset
  fragments[1][18] ^= 0xFFU;
  EXPECT_FALSE(nanoscan::decode_fragment(fragments[1]));
}

TEST(NanoscanProtocol, tells_glare_and_dirt_from_free_space_and_looks_ahead_at_90_degrees) {
  NanoscanProtocol protocol;
  nanoscan::Telegram telegram{.scan_time_ms = 40, .first_angle = 90 << 22U, .angle_step = 1 << 22U};
  using nanoscan::valid;
  telegram.points = {{1000, 0, valid},
                     {0, 0, nanoscan::infinite},
                     {1000, 0, valid | nanoscan::glare},
                     {1000, 0, valid | nanoscan::contamination},
                     {1000, 0, valid | nanoscan::contamination_warning},
                     {30, 0, valid}};
  for (const Bytes& datagram : nanoscan::fragments_of(nanoscan::encode(telegram), 1))
    protocol.take(datagram, Stamp(std::chrono::seconds(1)));
  const std::optional<Scan> scan = protocol.next();
  ASSERT_TRUE(scan);
  const std::vector<Echo> echoes{Echo::hit,     Echo::nothing, Echo::invalid,
                                 Echo::invalid, Echo::hit,     Echo::too_near};
  for (std::size_t i = 0; i < echoes.size(); ++i) EXPECT_EQ(scan->beams[i].echo, echoes[i]) << i;
  EXPECT_NEAR(scan->beams[0].angle_rad, 0.0, 1e-9);
  EXPECT_NEAR(scan->beams[1].angle_rad, radians(1.0), 1e-9);
}

}  // namespace
}  // namespace lodestar
