#include "app/console/run_archive.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "app/console/document_history.hpp"
#include "maps/geometry.hpp"
#include "maps/input_error.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t most_poses = 20'000;

bool is_run(const fs::directory_entry& entry) {
  return !entry.is_symlink() && entry.is_directory() && fs::is_regular_file(entry.path() / "summary.json") &&
         fs::is_regular_file(entry.path() / "estimate.tum");
}

double rounded(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit;
}

}  // namespace

ordered_json trajectory_json(const std::string& tum, const fs::path& file, std::size_t most) {
  const auto lines = static_cast<std::size_t>(std::ranges::count(tum, '\n')) + 1;
  const std::size_t stride = (lines + most - 1) / most;
  ordered_json rows = ordered_json::array();
  std::istringstream stream(tum);
  int line = 0;
  for (std::string text; std::getline(stream, text);) {
    ++line;
    if (text.empty() || text.front() == '#' || static_cast<std::size_t>(line) % stride != 0) continue;
    std::istringstream words(text);
    std::array<double, 8> v{};  // stamp, position, quaternion x y z w
    for (double& value : v) words >> value;
    if (!words) throw InputError(file, line, "'" + text.substr(0, 80) + "'", "eight numbers");
    const double yaw_rad =
        std::atan2(2.0 * (v[7] * v[6] + v[4] * v[5]), 1.0 - 2.0 * (v[5] * v[5] + v[6] * v[6]));
    rows.push_back(
        {rounded(v[0], 1e4), rounded(v[1], 1e5), rounded(v[2], 1e5), rounded(degrees(yaw_rad), 1e3)});
  }
  return rows;
}

std::vector<std::string> RunArchive::names() const {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, none)) {
    if (is_run(entry)) names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

std::optional<ordered_json> RunArchive::run(const std::string& name) const {
  const std::vector<std::string> all = names();
  const auto found = std::ranges::find(all, name);
  if (found == all.end()) return std::nullopt;
  const fs::path folder = folder_ / *found;
  const ordered_json summary = ordered_json::parse(read_document(folder / "summary.json"), nullptr, false);
  if (summary.is_discarded()) throw InputError(folder / "summary.json", 0, "broken JSON", "a summary");
  ordered_json run{{"name", *found}, {"summary", summary}};
  for (const char* which : {"estimate", "truth"}) {
    const fs::path file = folder / (std::string(which) + ".tum");
    run[which] = fs::is_regular_file(file) ? trajectory_json(read_document(file), file, most_poses)
                                           : ordered_json::array();
  }
  return run;
}

}  // namespace lodestar
