#include "maps/camera_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <span>
#include <string>

#include "maps/atomic_file.hpp"
#include "maps/file_text.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr int max_image_side_px = 32768;

/// The values of either kind of file, before they are checked.
struct Calibration {
  int width_px = 0;
  int height_px = 0;
  std::vector<double> matrix;  ///< 9, row by row
  std::string model = "plumb_bob";
  std::vector<double> coefficients;
};

Distortion distortion_of(const Calibration& calibration, const StrictYaml& yaml) {
  if (calibration.model == "plumb_bob") return Distortion::plumb_bob;
  if (calibration.model == "rational_polynomial") return Distortion::rational_polynomial;
  if (calibration.model == "equidistant") return Distortion::equidistant;
  yaml.refuse("distortion_model", "'" + calibration.model + "'",
              "plumb_bob, rational_polynomial or equidistant");
  return Distortion::none;
}

bool count_fits(Distortion distortion, std::size_t count) {
  if (distortion == Distortion::equidistant) return count == 4;
  if (distortion == Distortion::rational_polynomial) return count == 8;
  return count == 0 || count == 4 || count == 5;
}

void check_matrix(const Calibration& calibration, const StrictYaml& yaml) {
  const std::vector<double>& k = calibration.matrix;
  const auto wants = [&](bool good, const std::string& found, const std::string& wanted) {
    if (!good) yaml.refuse("camera_matrix", found, wanted);
  };
  wants(k[0] > 0.0 && k[4] > 0.0, fmt::format("focal lengths {} and {}", k[0], k[4]), "positive ones");
  wants(k[1] == 0.0, fmt::format("a skew of {}", k[1]), "0");
  wants(k[3] == 0.0 && k[6] == 0.0 && k[7] == 0.0 && k[8] == 1.0,
        "entries below the diagonal or a last one other than 1", "fx 0 cx 0 fy cy 0 0 1");
  wants(k[2] >= 0.0 && k[2] <= calibration.width_px && k[5] >= 0.0 && k[5] <= calibration.height_px,
        fmt::format("a principal point ({}, {}) outside the image", k[2], k[5]), "one inside");
}

CameraModel model_of(const Calibration& calibration, const StrictYaml& yaml) {
  check_matrix(calibration, yaml);
  CameraModel camera{.width_px = calibration.width_px,
                     .height_px = calibration.height_px,
                     .fx_px = calibration.matrix[0],
                     .fy_px = calibration.matrix[4],
                     .cx_px = calibration.matrix[2],
                     .cy_px = calibration.matrix[5]};
  camera.distortion = distortion_of(calibration, yaml);
  if (!count_fits(camera.distortion, calibration.coefficients.size())) {
    yaml.refuse("distortion_coefficients", fmt::format("{} values", calibration.coefficients.size()),
                "0, 4 or 5 (plumb_bob), 8 (rational_polynomial), 4 (equidistant)");
  }
  std::ranges::copy(calibration.coefficients, camera.coefficients.begin());
  const bool is_ideal = std::ranges::all_of(calibration.coefficients, [](double k) { return k == 0.0; });
  if (is_ideal && camera.distortion != Distortion::equidistant) camera.distortion = Distortion::none;
  camera.limit_rays();
  return camera;
}

/// `{rows: R, cols: C, data: [...]}`
std::vector<double> read_matrix(StrictYaml yaml, int wanted_rows, std::optional<int> wanted_columns) {
  const int rows = yaml.integer("rows", 1, 1000);
  const int columns = yaml.integer("cols", 0, 1000);
  if (rows != wanted_rows) yaml.refuse("rows", fmt::format("{}", rows), fmt::format("{}", wanted_rows));
  if (wanted_columns && columns != *wanted_columns) {
    yaml.refuse("cols", fmt::format("{}", columns), fmt::format("{}", *wanted_columns));
  }
  std::vector<double> data =
      yaml.numbers("data", static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  yaml.finish();
  return data;
}

/// Keys of camera_info that localization from single images does not use, but that are valid in the file.
void read_unused(StrictYaml& yaml) {
  if (yaml.has("camera_name")) (void)yaml.node("camera_name");
  if (yaml.has("rectification_matrix")) (void)read_matrix(yaml.mapping("rectification_matrix"), 3, 3);
  if (yaml.has("projection_matrix")) (void)read_matrix(yaml.mapping("projection_matrix"), 3, 4);
  for (const std::string key : {"binning_x", "binning_y"}) {
    if (yaml.has(key) && yaml.integer(key, 0, 64) > 1) yaml.refuse(key, "binned images", "0 or 1");
  }
  if (yaml.has("roi")) (void)yaml.node("roi");
}

CameraFile load_camera_info(const fs::path& file, const std::string& text) {
  StrictYaml yaml = StrictYaml::parse(text, file);
  Calibration calibration;
  calibration.width_px = yaml.integer("image_width", 1, max_image_side_px);
  calibration.height_px = yaml.integer("image_height", 1, max_image_side_px);
  calibration.matrix = read_matrix(yaml.mapping("camera_matrix"), 3, 3);
  if (yaml.has("distortion_model")) calibration.model = yaml.text("distortion_model");
  calibration.coefficients = read_matrix(yaml.mapping("distortion_coefficients"), 1, std::nullopt);
  read_unused(yaml);
  CameraFile read{.camera = model_of(calibration, yaml), .other_keys = {}, .warnings = {}};
  for (const StrictYaml::OtherKey& key : yaml.take_other_keys()) {
    read.other_keys += key.yaml + "\n";
    read.warnings.push_back(fmt::format("{}:{}: the key '{}' is not known here and has no effect",
                                        file.string(), key.line, key.name));
  }
  return read;
}

/// An !!opencv-matrix with the given number of entries, as a row or as a column.
std::vector<double> read_opencv_matrix(StrictYaml yaml, int rows, std::optional<int> columns) {
  const int found_rows = yaml.integer("rows", 1, 1000);
  const int found_columns = yaml.integer("cols", 1, 1000);
  const bool fits =
      columns ? found_rows == rows && found_columns == *columns : found_rows == rows || found_columns == rows;
  if (!fits)
    yaml.refuse("rows", fmt::format("{} x {} numbers", found_rows, found_columns),
                columns ? fmt::format("{} x {}", rows, *columns) : "a row or a column");
  return yaml.numbers("data", static_cast<std::size_t>(found_rows) * static_cast<std::size_t>(found_columns));
}

/// The format that OpenCV's calibration writes: YAML but for its first line. Read without cv::FileStorage,
/// which never returns from some malformed files. Other keys (flags, errors) are ignored.
CameraModel load_file_storage(const fs::path& file, std::string text) {
  text.front() = '#';
  StrictYaml yaml = StrictYaml::parse(text, file);
  Calibration calibration;
  calibration.width_px = yaml.integer("image_width", 1, max_image_side_px);
  calibration.height_px = yaml.integer("image_height", 1, max_image_side_px);
  calibration.matrix = read_opencv_matrix(yaml.mapping("camera_matrix"), 3, 3);
  calibration.coefficients = read_opencv_matrix(yaml.mapping("distortion_coefficients"), 1, std::nullopt);
  if (calibration.coefficients.size() == 8) calibration.model = "rational_polynomial";
  return model_of(calibration, yaml);
}

std::string_view model_name(Distortion distortion) {
  if (distortion == Distortion::equidistant) return "equidistant";
  if (distortion == Distortion::rational_polynomial) return "rational_polynomial";
  return "plumb_bob";
}

std::size_t written_count(Distortion distortion) {
  if (distortion == Distortion::equidistant) return 4;
  return distortion == Distortion::rational_polynomial ? 8 : 5;
}

}  // namespace

CameraModel load_camera(const fs::path& file) {
  return read_camera_file(file).camera;
}

CameraFile read_camera_file(const fs::path& file) {
  const std::string text = file_text(file, "a YAML file");
  if (!text.starts_with("%YAML:1.0")) return load_camera_info(file, text);
  return {.camera = load_file_storage(file, text), .other_keys = {}, .warnings = {}};
}

void save_camera(const CameraModel& camera, const std::string& name, const fs::path& file) {
  save_camera(camera, name, file, "");
}

void save_camera(const CameraModel& camera, const std::string& name, const fs::path& file,
                 const std::string& other_keys) {
  const std::size_t count = written_count(camera.distortion);
  const std::span coefficients = std::span(camera.coefficients).first(count);
  const auto [fx, fy, cx, cy] = std::array{camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px};
  std::string text = fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", camera.width_px,
                                 camera.height_px, YAML::Dump(YAML::Node(name)));
  text += fmt::format("camera_matrix: {{rows: 3, cols: 3, data: [{}, 0, {}, 0, {}, {}, 0, 0, 1]}}\n", fx, cx,
                      fy, cy);
  text += fmt::format("distortion_model: {}\n", model_name(camera.distortion));
  text += fmt::format("distortion_coefficients: {{rows: 1, cols: {}, data: [{}]}}\n", count,
                      fmt::join(coefficients, ", "));
  text += "rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n";
  text +=
      fmt::format("projection_matrix: {{rows: 3, cols: 4, data: [{}, 0, {}, 0, 0, {}, {}, 0, 0, 0, 1, 0]}}\n",
                  fx, cx, fy, cy);
  write_file_atomically(file, text + other_keys);
}

}  // namespace lodestar
