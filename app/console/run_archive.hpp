#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/console/run_heat.hpp"

namespace lodestar {

/// The run folders below one folder, as `replay -o` writes them. A run's name is that of its folder; a
/// requested name is only compared with the existing ones, never used as a path. For one thread at a time.
class RunArchive {
 public:
  explicit RunArchive(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Names of all runs, the newest last; none when the folder does not exist. Symbolic links are skipped.
  [[nodiscard]] std::vector<std::string> names() const;

  /// What a list shows of each, in the same order: see run_facts.hpp.
  [[nodiscard]] nlohmann::ordered_json list() const;

  /// {"name", "started", "summary", "map", "registry", "estimate", "truth", "steps", "fixes", "pictures"}:
  /// the summary as it was written; map and registry that it drove on, null for runs that do not have them;
  /// the trajectories as rows of seconds, x, y (metres) and yaw (degrees), in the map; the numbers of
  /// steps.csv and fixes.csv; names of the pictures. Nothing for an unknown name. Throws InputError for a run
  /// that cannot be read.
  [[nodiscard]] std::optional<nlohmann::ordered_json> run(const std::string& name) const;

  /// The cells of the map that it drove on, one byte each, bottom row first; nothing when there are none.
  [[nodiscard]] std::optional<std::string> cells(const std::string& name) const;

  /// Where the newest runs of a site (by its name) went badly, all of them together. See RunHeat.
  [[nodiscard]] nlohmann::ordered_json heat(const std::string& site) const;

  /// A picture by its name among run()["pictures"], as JPEG; nothing when there is none.
  [[nodiscard]] std::optional<std::string> picture(const std::string& name, const std::string& picture) const;

 private:
  /// Of one run, once it is complete, for as long as its summary stands as it was read.
  struct Known {
    std::filesystem::file_time_type written;
    bool is_complete = false;
    nlohmann::ordered_json facts;
    std::optional<RunHeat> heat;
  };

  /// Nothing for an unknown name.
  [[nodiscard]] std::optional<std::filesystem::path> folder_of(const std::string& name) const;
  Known& known(const std::string& name) const;

  std::filesystem::path folder_;
  mutable std::map<std::string, Known> known_;
};

/// The rows of a TUM trajectory, thinned evenly to at most `most`. Throws InputError with the line of a row
/// that is not a pose.
nlohmann::ordered_json trajectory_json(const std::string& tum, const std::filesystem::path& file,
                                       std::size_t most);

/// The numbers of each row of a table with a header, also those joined by a plus; thinned as above. Throws
/// InputError with the line for a row that does not begin with a number.
nlohmann::ordered_json numbers_json(const std::string& csv, const std::filesystem::path& file,
                                    std::size_t most);

}  // namespace lodestar
