#include "app/recording/scan_log.hpp"

#include <bit>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "maps/input_error.hpp"
#include "maps/random.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const ScannerMount mount{.base_from_scanner = {{0.12, -0.03}, 3.1}, .height_m = 0.18};

Scan random_scan(Random& random, int beams) {
  Scan scan{.min_range_m = 0.05};
  for (int i = 0; i < beams; ++i)
    scan.beams.push_back({.stamp = Stamp(Duration(static_cast<std::int64_t>(random.bits() >> 2U))),
                          .angle_rad = random.uniform(-3.14, 3.14),
                          .range_m = random.uniform(0.0, 30.0),
                          .intensity = static_cast<float>(random.uniform()),
                          .echo = static_cast<Echo>(random.below(4))});
  return scan;
}

/// A file of three scans: 5, 0 and 7 beams.
std::string three_scans() {
  Random random(1);
  std::string bytes = scan_file_header(mount);
  for (const int beams : {5, 0, 7})
    bytes += scan_file_record({Stamp(Duration(9)), random_scan(random, beams)});
  return bytes;
}

std::string refusal_of(const std::filesystem::path& file) {
  try {
    ScanFileReader reader(file);
    while (reader.next()) {
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(ScanLog, gives_back_every_scan_to_the_bit) {
  const TemporaryFolder folder;
  Random random(4);
  std::vector<Scan> scans;
  for (int i = 0; i < 40; ++i) scans.push_back(random_scan(random, 10 * (i % 7)));
  {
    ScanLog log(folder.path(), mount, {});
    for (std::size_t i = 0; i < scans.size(); i += 2)
      log.take({.now = Stamp(Duration(1000 + i)), .scans = {scans[i], scans[i + 1]}});
    EXPECT_EQ(log.finish(), "");
  }
  ScanFileReader reader(folder / "scans.bin");
  EXPECT_EQ(reader.mount().base_from_scanner.position_m, mount.base_from_scanner.position_m);
  EXPECT_EQ(reader.mount().base_from_scanner.yaw_rad, mount.base_from_scanner.yaw_rad);
  EXPECT_EQ(reader.mount().height_m, mount.height_m);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::optional<LoggedScan> read = reader.next();
    ASSERT_TRUE(read);
    EXPECT_EQ(read->arrival, Stamp(Duration(1000 + i - i % 2)));
    EXPECT_EQ(read->scan.min_range_m, 0.05);
    EXPECT_TRUE(std::isinf(read->scan.max_range_m));
    ASSERT_EQ(read->scan.beams.size(), scans[i].beams.size());
    for (std::size_t k = 0; k < scans[i].beams.size(); ++k) {
      const Beam& is = read->scan.beams[k];
      const Beam& was = scans[i].beams[k];
      EXPECT_EQ(is.stamp, was.stamp);
      EXPECT_EQ(is.angle_rad, was.angle_rad);
      EXPECT_EQ(is.range_m, was.range_m);
      EXPECT_EQ(is.intensity, was.intensity);
      EXPECT_EQ(is.echo, was.echo);
    }
  }
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.bytes_cut_off(), 0U);
}

TEST(ScanFile, has_the_bytes_that_its_page_says) {
  const Scan scan{.beams = {{.stamp = Stamp(Duration(0x0102)),
                             .angle_rad = 1.0,
                             .range_m = 2.0,
                             .intensity = 1.0F,
                             .echo = Echo::too_near}},
                  .min_range_m = 1.0,
                  .max_range_m = 2.0};
  const std::string bytes = scan_file_record({Stamp(Duration(3)), scan});
  const std::string one("\0\0\0\0\0\0\xf0\x3f", 8);
  const std::string two("\0\0\0\0\0\0\0\x40", 8);
  ASSERT_EQ(bytes.size(), 36U + 29U);
  EXPECT_EQ(bytes.substr(0, 61), "SCAN" + std::string("\1\0\0\0", 4) + std::string("\3\0\0\0\0\0\0\0", 8) +
                                     one + two + std::string("\2\1\0\0\0\0\0\0", 8) + one + two +
                                     std::string("\0\0\x80\x3f\2", 5));
  EXPECT_EQ(scan_file_header(mount).size(), 44U);
}

TEST(ScanFile, cut_off_anywhere_in_its_last_record_keeps_the_others_and_says_so) {
  const TemporaryFolder folder;
  const std::string whole = three_scans();
  const std::size_t last_begins = whole.size() - (36 + 29 * 7);
  for (std::size_t size = last_begins; size < whole.size(); ++size) {
    ScanFileReader reader(folder.write("scans.bin", whole.substr(0, size)));
    EXPECT_TRUE(reader.next());
    EXPECT_TRUE(reader.next());
    EXPECT_FALSE(reader.next()) << size;
    EXPECT_EQ(reader.bytes_cut_off(), size - last_begins);
  }
}

TEST(ScanFile, with_any_byte_changed_is_refused_with_its_offset) {
  const TemporaryFolder folder;
  const std::string whole = three_scans();
  const std::size_t second_begins = 44 + 36 + 29 * 5;
  for (std::size_t at = second_begins; at < second_begins + 36; ++at) {
    std::string spoilt = whole;
    spoilt[at] = static_cast<char>(spoilt[at] ^ 0x10);
    // More beams than the file has room for look like a record that is cut off; all else is an error.
    const bool is_count = at - second_begins >= 4 && at - second_begins < 8;
    const std::string refusal = refusal_of(folder.write("scans.bin", spoilt));
    if (is_count && refusal.empty()) continue;
    EXPECT_THAT(refusal, AllOf(HasSubstr("scans.bin"), HasSubstr("at byte " + std::to_string(second_begins))))
        << at;
  }
}

TEST(ScanFile, that_is_none_is_refused) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal_of(folder / "none.bin"), HasSubstr("no file that can be read"));
  EXPECT_THAT(refusal_of(folder.write("a", "")), HasSubstr("at byte 0"));
  EXPECT_THAT(refusal_of(folder.write("b", "LSTRSCAN\1")), HasSubstr("header of 9 bytes"));
  std::string later = three_scans();
  later[8] = 2;
  EXPECT_THAT(refusal_of(folder.write("c", later)), HasSubstr("version 2"));
}

TEST(ScanLog, that_finds_no_room_says_how_much_is_missing) {
  const TemporaryFolder folder;
  std::vector<std::string> said;
  ScanLog log(folder.path(), mount,
              {.tell = [&said](const std::string& words) { said.push_back(words); },
               .disk = {.is_full = [] { return true; }}});
  Random random(2);
  for (int i = 0; i < 5; ++i) log.take({.scans = {random_scan(random, 100)}});
  EXPECT_THAT(log.finish(), HasSubstr("scans.bin"));
}

}  // namespace
}  // namespace lodestar
