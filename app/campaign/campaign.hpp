#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/simulate/simulated_drive.hpp"

namespace lodestar {

inline constexpr double silently_wrong_m = 0.10;  ///< from the goal, while arrival is reported

/// Contacts with people, each counted once: while the robot moved, of those the excused, and while it stood.
struct PeopleContacts {
  int moving = 0;
  int excused = 0;
  int at_rest = 0;
  double greatest_mps = 0.0;  ///< the robot's fastest in any of them
};

/// What the missions of a campaign meet.
struct CampaignWorld {
  bool has_people =
      false;  ///< one to six, drawn from the mission's number; boxes and chairs; a scanner on the robot
  bool has_faults = true;  ///< and registries that are not quite true
};

/// The outcome of one mission.
struct MissionOutcome {
  std::uint64_t mission = 0;  ///< its number, and its seed
  bool spared = false;        ///< of a campaign without faults
  std::vector<std::string> faults;
  bool arrived = false;
  double error_m = 0.0;  ///< true distance from the goal, when arrival was reported
  std::string failure;   ///< in words, when it did not arrive
  int contacts = 0;
  std::string excuse;     ///< of those with the map, as by excuse_for_contact(); empty for none
  double driven_s = 0.0;  ///< simulated
  /// From the start of the fault to the first notice or refused fix, for missions with exactly one fault.
  std::optional<double> noticed_after_s;
  std::optional<double> stopped_within_m;  ///< longest stopping distance after a reason to stop
  std::optional<PeopleContacts> people;    ///< of campaigns in which people walk about

  [[nodiscard]] bool hit_something() const {
    return (contacts > 0 && excuse.empty()) || (people && people->moving > 0);
  }
  [[nodiscard]] bool is_excused() const { return contacts > 0 && !hit_something(); }
  [[nodiscard]] bool silently_wrong() const { return arrived && error_m > silently_wrong_m; }
  [[nodiscard]] bool has_failed() const { return hit_something() || silently_wrong(); }
  /// What went wrong, or was excused, in words.
  [[nodiscard]] std::string what_happened() const;
};

nlohmann::ordered_json as_json(const MissionOutcome& outcome);
MissionOutcome outcome_from(const nlohmann::json& json);

/// The mission of a number: a building, a simulated drive and its faults.
struct CampaignMission {
  Site site;
  SimulatedDriveOptions replay;
};
CampaignMission mission_of(const Site& robot_and_cameras, const std::vector<int>& ids, std::uint64_t number,
                           const CampaignWorld& world = {});
MissionOutcome outcome_of(std::uint64_t number, const RunRecord& record, const Site& site,
                          const CampaignWorld& world = {});

struct CampaignOptions {
  std::uint64_t first = 1;  ///< number of the first mission
  int missions = 100;
  bool resume = false;  ///< skip the missions that missions.jsonl already has
  CampaignWorld world;
  std::function<bool()> goes_on = {};  ///< asked before and after each mission; false: no more begin
};

/// Runs the missions on all cores. Each outcome is appended to `folder`/missions.jsonl at once, so that an
/// interrupted campaign can be resumed. `done` is called after each, from any thread, with the completed
/// share. Returns the outcomes that there are by ascending number. Throws InputError when the folder cannot
/// be written, when it has outcomes that are not to be resumed or of another world, or when another campaign
/// writes there.
std::vector<MissionOutcome> run_campaign(const Site& robot_and_cameras, const CampaignOptions& options,
                                         const std::filesystem::path& folder,
                                         const std::function<void(double)>& done);

/// IDs with a minimum code distance of 3, enough for all markers of a building.
std::vector<int> campaign_ids();

}  // namespace lodestar
