#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lodestar {

/// The run folders below one folder, as `replay -o` writes them. A run's name is that of its folder; a
/// requested name is only compared with the existing ones, never used as a path.
class RunArchive {
 public:
  explicit RunArchive(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Names of all runs, the newest last; none when the folder does not exist. Symbolic links are skipped.
  [[nodiscard]] std::vector<std::string> names() const;

  /// {"name", "summary", "estimate", "truth", "steps", "fixes", "pictures"}: the summary as it was written;
  /// the trajectories as rows of seconds, x, y (metres) and yaw (degrees), in the map; the numbers of
  /// steps.csv and fixes.csv; names of the pictures. Nothing for an unknown name. Throws InputError for a run
  /// that cannot be read.
  [[nodiscard]] std::optional<nlohmann::ordered_json> run(const std::string& name) const;

  /// A picture by its name among run()["pictures"], as JPEG; nothing when there is none.
  [[nodiscard]] std::optional<std::string> picture(const std::string& name, const std::string& picture) const;

 private:
  /// Nothing for an unknown name.
  [[nodiscard]] std::optional<std::filesystem::path> folder_of(const std::string& name) const;

  std::filesystem::path folder_;
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
