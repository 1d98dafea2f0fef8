#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <yaml-cpp/yaml.h>

#include "app/common/json_parse.hpp"
#include "app/placement/formats.hpp"
#include "app/placement/poses.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"
#include "maps/registry_text.hpp"

// The readers of formats.hpp.
namespace lodestar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Collects markers and refuses invalid ones.
class Intake {
 public:
  explicit Intake(fs::path file) : file_(std::move(file)) {}

  void add(int line, double id, const Eigen::Isometry3d& pose, MarkerFrame frame) {
    if (!(id >= 0 && id < marker_id_count) || id != std::floor(id)) {
      throw InputError(file_, line, fmt::format("ID {}", id),
                       fmt::format("a whole number in 0..{}", marker_id_count - 1));
    }
    if (!pose.matrix().allFinite()) throw InputError(file_, line, "a number that is not finite", "metres");
    const auto [first, is_new] = line_of_id_.emplace(static_cast<int>(id), line);
    if (!is_new) throw InputError(file_, line, fmt::format("marker {} again", id), "each ID once");
    std::optional<RegisteredMarker> marker = marker_at(static_cast<int>(id), pose, frame);
    if (!marker) {
      throw InputError(file_, line, fmt::format("marker {} with a face that does not look down", id),
                       "one within 5 degrees, as on a ceiling");
    }
    marker->line = line;
    registry.markers.push_back(*marker);
  }

  void add_flat(int line, double id, const Vec3& at, double yaw_deg) {
    if (!std::isfinite(yaw_deg)) throw InputError(file_, line, "a yaw that is not finite", "degrees");
    const RegisteredMarker marker{0, at, radians(yaw_deg)};
    add(line, id, map_from_frame({}, marker, MarkerFrame::at_o), MarkerFrame::at_o);
  }

  MarkerRegistry registry;

 private:
  fs::path file_;
  std::map<int, int> line_of_id_;
};

Eigen::Isometry3d pose_of(const Vec3& at, const Eigen::Matrix3d& turn) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = at;
  pose.linear() = turn;
  return pose;
}

double number_in(const std::string& word, const fs::path& file, int line) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    throw InputError(file, line, "'" + word + "'", "a number");
  }
  return value;
}

std::string trimmed(const std::string& word) {
  const std::size_t first = word.find_first_not_of(" \t\r\"");
  if (first == std::string::npos) return "";
  return word.substr(first, word.find_last_not_of(" \t\r\"") - first + 1);
}

/// How a spreadsheet wrote its cells. Where the comma is the decimal mark, semicolons or tabs stand between
/// cells.
char separator_of(const std::string& header) {
  for (const char separator : {';', '\t'}) {
    if (header.find(separator) != std::string::npos) return separator;
  }
  return ',';
}

std::vector<std::string> cells_of(const std::string& row, char separator) {
  std::vector<std::string> cells;
  std::istringstream stream(row);
  for (std::string cell; std::getline(stream, cell, separator);) cells.push_back(trimmed(cell));
  return cells;
}

/// A number with a point, or with a comma where none stands between cells.
double decimal_in(std::string word, char separator, const fs::path& file, int line) {
  if (separator != ',' && word.find('.') == std::string::npos) std::ranges::replace(word, ',', '.');
  return number_in(word, file, line);
}

/// The columns by name, with or without their unit; size, name and dots are ignored.
std::map<std::string, std::size_t> columns_of(const std::string& header, char separator,
                                              const fs::path& file) {
  std::map<std::string, std::size_t> columns;
  const std::vector<std::string> names = cells_of(header, separator);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    const bool has_unit = name.ends_with("_m") && name.size() == 3;
    columns.emplace(has_unit ? name.substr(0, 1) : name, i);
  }
  for (const char* name : {"id", "x", "y", "z", "yaw_deg"}) {
    if (!columns.contains(name)) {
      throw InputError(file, 1, fmt::format("no column '{}'", name), "id,x,y,z,yaw_deg in the first line");
    }
  }
  return columns;
}

MarkerRegistry read_csv(const std::string& text, const fs::path& file) {
  Intake intake(file);
  std::istringstream stream(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text);
  std::string row;
  std::getline(stream, row);
  const char separator = separator_of(row);
  const std::map<std::string, std::size_t> columns = columns_of(row, separator, file);
  for (int line = 2; std::getline(stream, row); ++line) {
    if (trimmed(row).empty()) continue;
    const std::vector<std::string> cells = cells_of(row, separator);
    const auto number = [&](const char* name) {
      const std::size_t column = columns.at(name);
      return decimal_in(column < cells.size() ? cells[column] : "", separator, file, line);
    };
    intake.add_flat(line, number("id"), {number("x"), number("y"), number("z")}, number("yaw_deg"));
  }
  return intake.registry;
}

MarkerRegistry read_stargazer(const std::string& text, const fs::path& file) {
  Intake intake(file);
  try {
    const YAML::Node root = YAML::Load(text);
    if (!root.IsMap() || !root["Landmarks"]) throw InputError(file, 1, "no 'Landmarks'", "a list of them");
    for (const YAML::Node& landmark : root["Landmarks"]) {
      const int line = landmark.Mark().line + 1;
      const auto number = [&](const char* key) { return landmark[key].as<double>(); };
      const Vec3 r(number("rx"), number("ry"), number("rz"));
      const double angle = r.norm();
      const Vec3 axis = angle > 0.0 ? Vec3(r / angle) : Vec3::UnitZ();
      intake.add(
          line, landmark["HexID"].as<int>(),
          pose_of({number("x"), number("y"), number("z")}, Eigen::AngleAxisd(angle, axis).toRotationMatrix()),
          MarkerFrame::at_o);
    }
  } catch (const YAML::Exception& error) {
    throw InputError(file, error.mark.is_null() ? 0 : error.mark.line + 1,
                     "a broken landmark (" + error.msg + ")", "HexID, x, y, z, rx, ry, rz");
  }
  return intake.registry;
}

MarkerRegistry read_fiducial_slam(const std::string& text, const fs::path& file) {
  Intake intake(file);
  std::istringstream stream(text);
  int line = 0;
  for (std::string row; std::getline(stream, row);) {
    ++line;
    if (trimmed(row).empty() || row.front() == '#') continue;
    std::istringstream words(row);
    std::vector<double> v;
    for (std::string word; v.size() < 7 && words >> word;) v.push_back(number_in(word, file, line));
    if (v.size() < 7) {
      throw InputError(file, line, fmt::format("{} numbers", v.size()), "id x y z roll pitch yaw (degrees)");
    }
    const Eigen::Matrix3d turn = rotation_from({radians(v[4]), radians(v[5]), radians(v[6])});
    intake.add(line, v[0], pose_of({v[1], v[2], v[3]}, turn), MarkerFrame::at_center);
  }
  return intake.registry;
}

void read_apriltag(const json& root, Intake& intake) {
  for (const json& tag : root.at("tags")) {
    const json& at = tag.at("pose").at("translation");
    const json& q = tag.at("pose").at("rotation").at("quaternion");
    const Eigen::Quaterniond turn(q.at("W").get<double>(), q.at("X").get<double>(), q.at("Y").get<double>(),
                                  q.at("Z").get<double>());
    const Vec3 point(at.at("x").get<double>(), at.at("y").get<double>(), at.at("z").get<double>());
    intake.add(0, tag.at("ID").get<double>(), pose_of(point, turn.normalized().toRotationMatrix()),
               MarkerFrame::out_of_the_center);
  }
}

void read_geojson(const json& root, Intake& intake) {
  for (const json& feature : root.at("features")) {
    if (feature.at("geometry").at("type") != "Point") continue;  // edges of a route graph
    const auto at = feature.at("geometry").at("coordinates").get<std::vector<double>>();
    const json& properties = feature.at("properties");
    intake.add_flat(0, properties.at("id").get<double>(), {at.at(0), at.at(1), at.at(2)},
                    properties.at("yaw_deg").get<double>());
  }
}

json json_of(const std::string& text, const fs::path& file) {
  try {
    return parse_json(text);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

MarkerRegistry read_json(const std::string& text, const fs::path& file, void (*read)(const json&, Intake&)) {
  Intake intake(file);
  try {
    read(json_of(text, file), intake);
  } catch (const json::exception& error) {
    throw InputError(file, 0, error.what(), "the format's keys and numbers");
  } catch (const std::out_of_range&) {
    throw InputError(file, 0, "a point without a height", "three coordinates");
  }
  return intake.registry;
}

}  // namespace

MarkerRegistry parse_markers(const std::string& text, MarkerFormat format, const fs::path& file) {
  switch (format) {
    case MarkerFormat::lodestar:
      return parse_registry(text, file);
    case MarkerFormat::csv:
      return read_csv(text, file);
    case MarkerFormat::stargazer:
      return read_stargazer(text, file);
    case MarkerFormat::apriltag:
      return read_json(text, file, read_apriltag);
    case MarkerFormat::fiducial_slam:
      return read_fiducial_slam(text, file);
    case MarkerFormat::geojson:
      return read_json(text, file, read_geojson);
  }
  return {};
}

}  // namespace lodestar
