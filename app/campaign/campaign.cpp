#include "app/campaign/campaign.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fcntl.h>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <sys/file.h>
#include <unistd.h>

#include "app/campaign/excuse.hpp"
#include "app/campaign/random_faults.hpp"
#include "app/campaign/random_obstacles.hpp"
#include "app/campaign/random_site.hpp"
#include "app/common/json_text.hpp"
#include "app/common/parallel.hpp"
#include "app/common/whole_number.hpp"
#include "control/safety_stop.hpp"
#include "maps/input_error.hpp"
#include "maps/marker_code.hpp"
#include "maps/random.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

enum MissionPurpose : std::uint64_t { building = 1, faults, registry_errors, people };

std::map<std::uint64_t, MissionOutcome> outcomes_in(const fs::path& file) {
  std::map<std::uint64_t, MissionOutcome> outcomes;
  std::ifstream stream(file);
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (json.is_discarded()) continue;  // truncated when the campaign was killed: that mission is run again
    try {
      MissionOutcome outcome = outcome_from(json);
      outcomes[outcome.mission] = std::move(outcome);
    } catch (const std::exception& error) {
      throw InputError(file, number, error.what(), "a mission outcome as `campaign` writes it");
    }
  }
  return outcomes;
}

bool is_of(const MissionOutcome& outcome, const CampaignWorld& world) {
  return outcome.people.has_value() == world.has_people && outcome.spared != world.has_faults;
}

/// Holds the file of outcomes against other campaigns, which would mix their lines with ours.
class SoleWriter {
 public:
  /// Makes the file unless it is to be resumed.
  SoleWriter(const fs::path& file, bool resume) {
    constexpr mode_t readable_by_all = 0644;
    const int flags = O_RDWR | O_CREAT | O_CLOEXEC | (resume ? 0 : O_EXCL);
    descriptor_ = ::open(file.c_str(), flags, readable_by_all);
    if (descriptor_ < 0 && errno == EEXIST) {
      throw InputError(file, 0, "the outcomes of an earlier campaign",
                       "--resume to continue it, or another folder with -o");
    }
    if (descriptor_ < 0) throw InputError(file, 0, "a file that cannot be written", "one that can");
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(descriptor_);
    throw InputError(file, 0, "another campaign that writes there now", "another folder with -o");
  }
  ~SoleWriter() { ::close(descriptor_); }
  SoleWriter(const SoleWriter&) = delete;
  SoleWriter& operator=(const SoleWriter&) = delete;

 private:
  int descriptor_ = -1;
};

/// People and corners, which are no fault.
bool is_of_the_field(const NoticeRecord& notice) {
  using enum StopReason;
  return std::ranges::any_of(std::array{person_near, obstacle_ahead, hidden_corner},
                             [&](StopReason reason) { return notice.words == to_string(reason); });
}

/// Time from the start of the fault to the first notice or refused fix of the navigator.
std::optional<double> noticed_after_s(const RunRecord& record) {
  if (record.faults.size() != 1) return std::nullopt;
  const Stamp begin = record.faults.front().begin;
  std::optional<Stamp> first;
  const auto consider = [&](Stamp stamp) {
    if (stamp >= begin && (!first || stamp < *first)) first = stamp;
  };
  for (const NoticeRecord& notice : record.notices)
    if (!notice.words.empty() && !is_of_the_field(notice)) consider(notice.stamp);
  for (const FixRecord& fix : record.fixes)
    if (!fix.accepted) consider(fix.stamp);
  if (!first) return std::nullopt;
  return seconds(*first - begin);
}

/// The longest distance travelled from a reason to stop to standstill.
std::optional<double> stopped_within_m(const RunRecord& record) {
  constexpr double still_m = 0.0002;  // between two records
  constexpr double carried_m = 0.1;   // a longer step is a kidnapping, not wheel motion
  std::optional<double> longest;
  for (const NoticeRecord& notice : record.notices) {
    if (!notice.stops) continue;
    double way_m = 0.0;
    auto pose = std::ranges::lower_bound(record.truth, notice.stamp, {}, &TruePose::stamp);
    for (; pose != record.truth.end() && std::next(pose) != record.truth.end(); ++pose) {
      const double step_m =
          (std::next(pose)->map_from_base.position_m - pose->map_from_base.position_m).norm();
      if (step_m < still_m) break;
      if (step_m < carried_m) way_m += step_m;
    }
    longest = std::max(longest.value_or(0.0), way_m);
  }
  return longest;
}

/// Half of the missions drive under a registry that is not quite true, as if measured by tape or laser; in
/// half of those it says how well it was measured.
void spoil_registry(CampaignMission& mission, Random random) {
  if (random.uniform() < 0.5) return;
  Disturbances& by = mission.replay.disturbances;
  by.misplaced_m = random.uniform(0.001, 0.01);
  by.misturned_rad = radians(random.uniform(0.1, 1.0));
  by.tilted_rad = radians(random.uniform(0.0, 1.0));
  constexpr double print_sigma = 0.002;
  by.print_scale = 1.0 + print_sigma * random.normal();
  if (random.uniform() < 0.5) return;
  for (RegisteredMarker& marker : mission.site.registry.markers)
    marker.sigma = MarkerSigma{by.misplaced_m, by.misturned_rad};
}

}  // namespace

std::vector<int> campaign_ids() {
  constexpr int most = 64;
  return choose_marker_ids(most, {}, {.min_distance = 3});
}

CampaignMission mission_of(const Site& robot_and_cameras, const std::vector<int>& ids, std::uint64_t number,
                           const CampaignWorld& world) {
  const Random random(number);
  CampaignMission mission;
  mission.site = random_site(robot_and_cameras, ids, random.stream(building).bits());
  if (world.has_people && !mission.site.robot.scanner) mission.site.robot.scanner.emplace();
  mission.replay = {.camera = robot_and_cameras.default_camera, .seed = number, .goals = mission.site.goals};
  if (world.has_faults) {
    mission.replay.faults =
        random_faults(random.stream(faults).bits(), mission.site.robot.scanner.has_value());
    spoil_registry(mission, random.stream(registry_errors));
  }
  if (!world.has_people) return mission;
  constexpr std::uint64_t most_people = 6;
  mission.replay.people.count = 1 + static_cast<int>(random.stream(people).below(most_people));
  add_random_obstacles(mission.site, number, mission.replay);
  return mission;
}

MissionOutcome outcome_of(std::uint64_t number, const RunRecord& record, const Site& site,
                          const CampaignWorld& world) {
  const GoalRecord& goal = record.goals.front();
  MissionOutcome outcome{.mission = number, .spared = !world.has_faults};
  for (const FaultEvent& fault : record.faults) outcome.faults.emplace_back(to_string(fault.kind));
  outcome.arrived = goal.arrived;
  if (const auto score = record.score_of(0)) outcome.error_m = score->position_error_m;
  outcome.failure = goal.failure;
  outcome.contacts = record.contacts;
  if (record.contacts > 0) outcome.excuse = excuse_for_contact(record, site).value_or("");
  outcome.driven_s = record.truth.empty() ? 0.0 : seconds(record.truth.back().stamp);
  outcome.noticed_after_s = noticed_after_s(record);
  outcome.stopped_within_m = stopped_within_m(record);
  const ContactScore& score = record.contact_score;
  if (world.has_people)
    outcome.people = PeopleContacts{score.moving, score.excused, score.at_rest, score.greatest_contact_mps};
  return outcome;
}

std::string MissionOutcome::what_happened() const {
  if (is_excused()) return "excused contact, " + excuse;
  if (!hit_something()) return "silently wrong";
  return people && people->moving > 0 ? "contact with people or things that the map lacks" : "contact";
}

nlohmann::ordered_json as_json(const MissionOutcome& outcome) {
  const auto optional = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json{
      {"mission", outcome.mission},
      {"faults", outcome.faults},
      {"arrived", outcome.arrived},
      {"error_m", optional(outcome.arrived ? std::optional(outcome.error_m) : std::nullopt)},
      {"failure", outcome.failure},
      {"contacts", outcome.contacts},
      {"driven_s", outcome.driven_s},
      {"noticed_after_s", optional(outcome.noticed_after_s)},
      {"stopped_within_m", optional(outcome.stopped_within_m)}};
  if (!outcome.excuse.empty()) json["excuse"] = outcome.excuse;
  if (outcome.spared) json["without_faults"] = true;
  if (outcome.people) {
    json["people"] = {{"moving", outcome.people->moving},
                      {"excused", outcome.people->excused},
                      {"at_rest", outcome.people->at_rest},
                      {"greatest_mps", outcome.people->greatest_mps}};
  }
  return json;
}

/// Absent where nobody walked about.
std::optional<PeopleContacts> people_in(const nlohmann::json& json) {
  if (!json.contains("people")) return std::nullopt;
  const nlohmann::json& people = json.at("people");
  constexpr std::uint32_t most = std::numeric_limits<int>::max();
  const auto count = [&](const char* key) { return static_cast<int>(whole_number(people.at(key), most)); };
  return PeopleContacts{count("moving"), count("excused"), count("at_rest"),
                        people.at("greatest_mps").get<double>()};
}

MissionOutcome outcome_from(const nlohmann::json& json) {
  const auto optional = [&](const char* key) {
    return json.at(key).is_null() ? std::nullopt : std::optional(json.at(key).get<double>());
  };
  constexpr std::uint32_t most_contacts = std::numeric_limits<int>::max();
  return {.mission = json.at("mission").get_ref<const nlohmann::json::number_unsigned_t&>(),
          .spared = json.value("without_faults", false),
          .faults = json.at("faults"),
          .arrived = json.at("arrived"),
          .error_m = optional("error_m").value_or(0.0),
          .failure = json.at("failure"),
          .contacts = static_cast<int>(whole_number(json.at("contacts"), most_contacts)),
          .excuse = json.value("excuse", ""),
          .driven_s = json.at("driven_s"),
          .noticed_after_s = optional("noticed_after_s"),
          .stopped_within_m = optional("stopped_within_m"),
          .people = people_in(json)};
}

std::vector<MissionOutcome> run_campaign(const Site& robot_and_cameras, const CampaignOptions& options,
                                         const fs::path& folder, const std::function<void(double)>& done) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path file = folder / "missions.jsonl";
  const SoleWriter sole_writer(file, options.resume);
  auto known = options.resume ? outcomes_in(file) : std::map<std::uint64_t, MissionOutcome>();
  for (const auto& [number, outcome] : known)
    if (!is_of(outcome, options.world))
      throw InputError(file, 0, "outcomes of a campaign with other people or faults",
                       "--people and --no-faults as it began, or another folder with -o");
  std::ofstream log(file, std::ios::app);

  const std::vector<int> ids = campaign_ids();
  std::vector<std::optional<MissionOutcome>> outcomes(static_cast<std::size_t>(options.missions));
  const auto is_over = [&] { return options.goes_on && !options.goes_on(); };
  std::mutex mutex;
  int finished = 0;
  in_parallel(options.missions, [&](int i) {
    const std::uint64_t number = options.first + static_cast<std::uint64_t>(i);
    std::optional<MissionOutcome>& outcome = outcomes[static_cast<std::size_t>(i)];
    const auto before = known.find(number);
    if (before != known.end()) {
      outcome = before->second;
    } else {
      if (is_over()) return;
      CampaignMission mission = mission_of(robot_and_cameras, ids, number, options.world);
      mission.replay.goes_on = options.goes_on;
      const RunRecord record = simulate_drive(mission.site, mission.replay);
      if (is_over()) return;  // perhaps in the middle of this mission
      outcome = outcome_of(number, record, mission.site, options.world);
    }
    const std::lock_guard lock(mutex);
    if (before == known.end()) log << json_text(as_json(*outcome)) << "\n" << std::flush;
    if (!log) throw InputError(file, 0, "a file that cannot be written", "one that can");
    done(static_cast<double>(++finished) / options.missions);
  });
  std::vector<MissionOutcome> whole;
  for (std::optional<MissionOutcome>& outcome : outcomes)
    if (outcome) whole.push_back(std::move(*outcome));
  return whole;
}

}  // namespace lodestar
