#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "maps/geometry.hpp"

#include "tests/drivers/scanner/dialogue.hpp"

namespace lodestar {
namespace {

class Protocols : public testing::TestWithParam<Kind> {};
class StreamProtocols : public Protocols {};
class CheckedProtocols : public Protocols {};

constexpr auto name_of_test = [](const testing::TestParamInfo<Kind>& tested) {
  return name_of(tested.param);
};
INSTANTIATE_TEST_SUITE_P(All, Protocols, all_kinds, name_of_test);
INSTANTIATE_TEST_SUITE_P(All, StreamProtocols, stream_kinds, name_of_test);
INSTANTIATE_TEST_SUITE_P(All, CheckedProtocols, checked_kinds, name_of_test);

void expect_same(Kind kind, const Scan& served, const Scan& read) {
  ASSERT_EQ(read.beams.size(), served.beams.size());
  for (std::size_t i = 0; i < served.beams.size(); ++i) {
    const Beam& truth = served.beams[i];
    const Beam& beam = read.beams[i];
    ASSERT_EQ(beam.echo, readable(kind, truth.echo)) << i;
    ASSERT_NEAR(wrap_angle(beam.angle_rad - truth.angle_rad), 0.0, radians(0.017)) << i;
    // Device times are in whole milliseconds, and arrival is that of the packet's last beam.
    ASSERT_NEAR(seconds(beam.stamp - truth.stamp), 0.0, 0.0021) << i;
    if (beam.echo != Echo::hit) continue;
    ASSERT_NEAR(beam.range_m, truth.range_m, 0.5001 * unit_of(kind)) << i;
    if (kind == Kind::ld19 || kind == Kind::nanoscan) {
      ASSERT_NEAR(beam.intensity, truth.intensity, 0.003);
    }
  }
}

/// The scans that were read are the last of those served but for those still on the way.
void expect_read_back(Kind kind, const std::vector<Scan>& served, const std::vector<Scan>& read) {
  ASSERT_GE(read.size(), served.size() - 2);
  const std::size_t first = kind == Kind::scip || kind == Kind::nanoscan || kind == Kind::rplidar_standard ||
                                    kind == Kind::rplidar_hq
                                ? 0
                                : 1;  // the others show that a turn ended by the next one's beginning
  for (std::size_t i = 0; i < read.size(); ++i) {
    SCOPED_TRACE(testing::Message() << "turn " << i);
    expect_same(kind, served.at(first + i), read[i]);
  }
}

struct Served {
  std::vector<Scan> turns;
  std::vector<TimedBytes> packets;
};

Served serve(Dialogue& dialogue, int turns, std::uint64_t seed) {
  Random random(seed);
  Served served;
  for (int i = 0; i < turns; ++i) {
    served.turns.push_back(dialogue.turn(random));
    for (TimedBytes& packet : dialogue.stand_in->packets_of(served.turns.back()))
      served.packets.push_back(std::move(packet));
  }
  return served;
}

TEST_P(Protocols, read_back_what_the_stand_in_writes_to_one_unit) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Dialogue dialogue(GetParam());
    const Served served = serve(dialogue, 6, seed);
    for (const TimedBytes& packet : served.packets) dialogue.protocol->take(packet.bytes, packet.due);
    expect_read_back(GetParam(), served.turns, dialogue.all_scans());
    EXPECT_EQ(dialogue.protocol->counts().checksum_errors, 0U);
    EXPECT_EQ(dialogue.protocol->counts().skipped_bytes, 0U);
  }
}

TEST_P(StreamProtocols, read_the_same_wherever_the_stream_is_cut) {
  Random cuts(7);
  for (int round = 0; round < 20; ++round) {
    Dialogue whole(GetParam());
    Dialogue cut(GetParam());
    const Served served = serve(whole, 5, 3);
    serve(cut, 5, 3);
    for (const TimedBytes& packet : served.packets) {
      whole.protocol->take(packet.bytes, packet.due);
      ByteView rest = packet.bytes;
      while (!rest.empty()) {
        const std::size_t part = 1 + cuts.below(rest.size());
        cut.protocol->take(rest.first(part), packet.due);
        rest = rest.subspan(part);
      }
    }
    const std::vector<Scan> expected = whole.all_scans();
    const std::vector<Scan> read = cut.all_scans();
    ASSERT_EQ(read.size(), expected.size());
    ASSERT_GE(read.size(), 3U);
    for (std::size_t i = 0; i < read.size(); ++i) {
      ASSERT_EQ(read[i].beams.size(), expected[i].beams.size());
      for (std::size_t b = 0; b < read[i].beams.size(); ++b) {
        ASSERT_EQ(read[i].beams[b].range_m, expected[i].beams[b].range_m);
        ASSERT_EQ(read[i].beams[b].stamp, expected[i].beams[b].stamp);
      }
    }
  }
}

/// Whether this beam was served by any of the turns.
bool was_served(Kind kind, const std::vector<Scan>& turns, const Beam& beam) {
  return std::ranges::any_of(turns, [&](const Scan& turn) {
    return std::ranges::any_of(turn.beams, [&](const Beam& truth) {
      return readable(kind, truth.echo) == beam.echo &&
             std::abs(wrap_angle(truth.angle_rad - beam.angle_rad)) < radians(0.017) &&
             (beam.echo != Echo::hit || std::abs(truth.range_m - beam.range_m) < 0.00051);
    });
  });
}

TEST_P(CheckedProtocols, invent_no_range_from_a_corrupted_byte) {
  const Kind kind = GetParam();
  Random random(11);
  Dialogue writer(kind);
  const Served served = serve(writer, 4, 5);
  Bytes stream;
  for (const TimedBytes& packet : served.packets) append(stream, packet.bytes);
  int noticed = 0;
  constexpr int corruptions = 400;
  for (int i = 0; i < corruptions; ++i) {
    Bytes corrupted = stream;
    const std::size_t at = stream.size() / 4 + random.below(stream.size() / 2);
    corrupted[at] ^= static_cast<std::uint8_t>(1 + random.below(255));
    Dialogue reader(kind);
    reader.protocol->take(corrupted, writer.now);
    for (const Scan& scan : reader.all_scans()) {
      // A tenth of the beams is enough to find an invented packet.
      for (std::size_t b = i % 10; b < scan.beams.size(); b += 10)
        ASSERT_TRUE(was_served(kind, served.turns, scan.beams[b])) << "byte " << at << " beam " << b;
    }
    const ProtocolCounts counts = reader.protocol->counts();
    if (counts.checksum_errors + counts.skipped_bytes > 0) ++noticed;
  }
  EXPECT_EQ(noticed, corruptions);
}

TEST_P(Protocols, recover_from_any_noise) {
  Random random(23);
  Dialogue dialogue(GetParam());
  for (int i = 0; i < 200; ++i) {
    Bytes noise(random.below(300));
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random.bits());
    dialogue.protocol->take(noise, dialogue.now);
  }
  dialogue.all_scans();
  const Served served = serve(dialogue, 8, 2);
  for (const TimedBytes& packet : served.packets) dialogue.protocol->take(packet.bytes, packet.due);
  const std::vector<Scan> read = dialogue.all_scans();
  ASSERT_GE(read.size(), 4U);
  EXPECT_EQ(read.back().beams.size(), served.turns.back().beams.size());
}

TEST_P(Protocols, begin_anew_when_the_device_was_replugged) {
  Dialogue dialogue(GetParam());
  Served served = serve(dialogue, 3, 2);
  for (const TimedBytes& packet : served.packets) dialogue.protocol->take(packet.bytes, packet.due);
  dialogue.all_scans();
  dialogue.stand_in->forget_client();
  dialogue.protocol->connect(dialogue.now);
  for (int i = 0; i < 40; ++i) dialogue.exchange();
  served = serve(dialogue, 4, 3);
  for (const TimedBytes& packet : served.packets) dialogue.protocol->take(packet.bytes, packet.due);
  expect_read_back(GetParam(), served.turns, dialogue.all_scans());
}

}  // namespace
}  // namespace lodestar
