#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

namespace lodestar {

/// Where on the floor runs went badly: for each square of 25 cm how sure of its position the robot was at
/// worst, how far off it was at worst (which only simulated worlds know), for how long it saw no marker, and
/// for how long it stood because it had to.
class RunHeat {
 public:
  static constexpr double square_m = 0.25;

  /// Adds a run, as RunArchive::run() has it.
  void add(const nlohmann::ordered_json& run);
  void add(const RunHeat& other);

  /// {"square_m", "squares": [[x, y, worst_3_sigma_mm, worst_error_mm, blind_s, waiting_s], ...]}: the middle
  /// of each square where a robot was, in the map; the error is null where nobody knows it.
  [[nodiscard]] nlohmann::ordered_json json() const;

 private:
  struct Square {
    double sigma_m = 0.0;
    double error_m = -1.0;  ///< below 0: unknown
    double blind_s = 0.0;
    double waiting_s = 0.0;
  };

  Square& at(double x_m, double y_m);
  void add_steps(const nlohmann::ordered_json& run);
  void add_waits(const nlohmann::ordered_json& run);

  std::map<std::pair<int, int>, Square> squares_;
};

}  // namespace lodestar
