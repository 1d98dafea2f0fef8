#include "drivers/simulation/fault_file.hpp"

#include <filesystem>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>

#include "maps/geometry.hpp"
#include "maps/input_error.hpp"

#include "tests/maps/temporary_folder.hpp"

namespace lodestar {
namespace {

using ::testing::HasSubstr;

const std::string head = "format: lodestar-faults\nversion: 1\nfaults:\n";

std::vector<Fault> faults_in(const std::string& text) {
  const TemporaryFolder folder;
  return load_faults(folder.write("faults.yaml", text));
}

std::string complaint_about(const std::string& entry) {
  try {
    (void)faults_in(head + "  - " + entry + "\n");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FaultFile, says_what_goes_wrong_when_where_and_by_how_much) {
  const auto faults = faults_in(head +
                                "  - {fault: marker_moved, at_s: 6, for_s: 2.5, marker: 447, shift_m: 0.3, "
                                "direction_deg: 90, turn_deg: -10}\n"
                                "  - {fault: can_loss, between_s: [4, 9], share: 0.3}\n");
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].kind, FaultKind::marker_moved);
  EXPECT_EQ(faults[0].begin, std::chrono::seconds(6));
  EXPECT_EQ(faults[0].lasts, std::chrono::milliseconds(2500));
  EXPECT_EQ(faults[0].marker, 447);
  EXPECT_EQ(faults[0].shift_m, 0.3);
  EXPECT_DOUBLE_EQ(faults[0].direction_rad, radians(90.0));
  EXPECT_DOUBLE_EQ(faults[0].turn_rad, radians(-10.0));
  const auto of_scanner = faults_in(head +
                                    "  - {fault: scanner_dirty, at_s: 6, direction_deg: 90, width_deg: 12, "
                                    "near_share: 0.5}\n"
                                    "  - {fault: scanner_clock, at_s: 6, jump_s: 0, drift_s_per_s: -0.1}\n");
  EXPECT_DOUBLE_EQ(of_scanner.at(0).width_rad, radians(12.0));
  EXPECT_EQ(of_scanner.at(0).share, 0.5);
  EXPECT_EQ(of_scanner.at(1).drift_s_per_s, -0.1);
  EXPECT_EQ(faults[1].latest_begin, std::chrono::seconds(9));
  EXPECT_FALSE(faults[1].lasts);
  EXPECT_EQ(faults[1].share, 0.3);
}

TEST(FaultFile, is_refused_with_its_line_when_anything_is_odd) {
  EXPECT_THAT(complaint_about("{fault: earthquake, at_s: 1}"), HasSubstr("faults.yaml:4"));
  EXPECT_THAT(complaint_about("{fault: earthquake, at_s: 1}"), HasSubstr("markers_occluded"));
  EXPECT_THAT(complaint_about("{fault: can_loss, at_s: 1, share: 1.5}"), HasSubstr("share"));
  EXPECT_THAT(complaint_about("{fault: can_loss, at_s: 1}"), HasSubstr("share"));
  EXPECT_THAT(complaint_about("{fault: can_loss, share: 0.5}"), HasSubstr("at_s"));
  EXPECT_THAT(complaint_about("{fault: can_loss, between_s: [5, 2], share: 0.5}"), HasSubstr("between_s"));
  EXPECT_THAT(complaint_about("{fault: camera_black, at_s: 1, marker: 3}"), HasSubstr("marker"));
  EXPECT_THAT(complaint_about("{fault: scanner_motor, at_s: 1, speed_share: 0}"), HasSubstr("speed_share"));
  EXPECT_THAT(complaint_about("{fault: scanner_clock, at_s: 1, jump_s: 0}"), HasSubstr("drift_s_per_s"));
  EXPECT_THAT(complaint_about("{fault: kidnapping, at_s: 1, for_s: 3, shift_m: 1, turn_deg: 0}"),
              HasSubstr("for_s"));
}

TEST(FaultFile, library_has_every_kind) {
  std::set<FaultKind> found;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(LODESTAR_SOURCE_DIR) / "faults")) {
    const std::vector<Fault> faults = load_faults(entry.path());
    EXPECT_FALSE(faults.empty()) << entry.path();
    for (const Fault& fault : faults) found.insert(fault.kind);
  }
  EXPECT_EQ(found.size(), all_fault_kinds().size());
}

}  // namespace
}  // namespace lodestar
