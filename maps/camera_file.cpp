#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <functional>
#include <opencv2/core.hpp>
#include <span>
#include <stdexcept>
#include <string>

#include "maps/atomic_file.hpp"
#include "maps/camera_model.hpp"
#include "maps/input_error.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr int max_side_px = 32768;

/// What both kinds of file say, before it is judged.
struct Calibration {
  int width_px = 0;
  int height_px = 0;
  std::vector<double> matrix;  ///< 9, row by row
  std::string model = "plumb_bob";
  std::vector<double> coefficients;
};

/// Where in the file a part of the calibration stands, for messages.
using Refuse =
    std::function<void(const std::string& key, const std::string& found, const std::string& wanted)>;

Distortion distortion_of(const Calibration& calibration, const Refuse& refuse) {
  if (calibration.model == "plumb_bob") return Distortion::plumb_bob;
  if (calibration.model == "rational_polynomial") return Distortion::rational_polynomial;
  if (calibration.model == "equidistant") return Distortion::equidistant;
  refuse("distortion_model", "'" + calibration.model + "'", "plumb_bob, rational_polynomial or equidistant");
  return Distortion::none;
}

bool count_fits(Distortion distortion, std::size_t count) {
  if (distortion == Distortion::equidistant) return count == 4;
  if (distortion == Distortion::rational_polynomial) return count == 8;
  return count == 0 || count == 4 || count == 5;
}

void check_matrix(const Calibration& calibration, const Refuse& refuse) {
  const std::vector<double>& k = calibration.matrix;
  const auto wants = [&](bool good, const std::string& found, const std::string& wanted) {
    if (!good) refuse("camera_matrix", found, wanted);
  };
  wants(k[0] > 0.0 && k[4] > 0.0, fmt::format("focal lengths {} and {}", k[0], k[4]), "positive ones");
  wants(k[1] == 0.0, fmt::format("a skew of {}", k[1]), "0");
  wants(k[3] == 0.0 && k[6] == 0.0 && k[7] == 0.0 && k[8] == 1.0,
        "entries below the diagonal or a last one other than 1", "fx 0 cx 0 fy cy 0 0 1");
  wants(k[2] >= 0.0 && k[2] <= calibration.width_px && k[5] >= 0.0 && k[5] <= calibration.height_px,
        fmt::format("a principal point ({}, {}) outside the image", k[2], k[5]), "one inside");
}

CameraModel model_of(const Calibration& calibration, const Refuse& refuse) {
  check_matrix(calibration, refuse);
  CameraModel camera{.width_px = calibration.width_px,
                     .height_px = calibration.height_px,
                     .fx_px = calibration.matrix[0],
                     .fy_px = calibration.matrix[4],
                     .cx_px = calibration.matrix[2],
                     .cy_px = calibration.matrix[5]};
  camera.distortion = distortion_of(calibration, refuse);
  if (!count_fits(camera.distortion, calibration.coefficients.size())) {
    refuse("distortion_coefficients", fmt::format("{} values", calibration.coefficients.size()),
           "0, 4 or 5 (plumb_bob), 8 (rational_polynomial), 4 (equidistant)");
  }
  std::ranges::copy(calibration.coefficients, camera.coefficients.begin());
  const bool is_ideal = std::ranges::all_of(calibration.coefficients, [](double k) { return k == 0.0; });
  if (is_ideal && camera.distortion != Distortion::equidistant) camera.distortion = Distortion::none;
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

/// Keys of camera_info that a pose from single images has no use for, but that belong in the file.
void read_unused(StrictYaml& yaml) {
  if (yaml.has("camera_name")) (void)yaml.node("camera_name");
  if (yaml.has("rectification_matrix")) (void)read_matrix(yaml.mapping("rectification_matrix"), 3, 3);
  if (yaml.has("projection_matrix")) (void)read_matrix(yaml.mapping("projection_matrix"), 3, 4);
  for (const std::string key : {"binning_x", "binning_y"}) {
    if (yaml.has(key) && yaml.integer(key, 0, 64) > 1) yaml.refuse(key, "binned images", "0 or 1");
  }
  if (yaml.has("roi")) (void)yaml.node("roi");
}

CameraModel load_camera_info(const fs::path& file) {
  StrictYaml yaml = StrictYaml::load(file);
  Calibration calibration;
  calibration.width_px = yaml.integer("image_width", 1, max_side_px);
  calibration.height_px = yaml.integer("image_height", 1, max_side_px);
  calibration.matrix = read_matrix(yaml.mapping("camera_matrix"), 3, 3);
  if (yaml.has("distortion_model")) calibration.model = yaml.text("distortion_model");
  calibration.coefficients = read_matrix(yaml.mapping("distortion_coefficients"), 1, std::nullopt);
  read_unused(yaml);
  yaml.finish();
  return model_of(calibration, [&yaml](const std::string& key, const std::string& found,
                                       const std::string& wanted) { yaml.refuse(key, found, wanted); });
}

/// FileStorage keeps no line numbers; the line of a key is looked up in the text.
int line_of_key(const std::string& text, const std::string& key) {
  const std::size_t at = text.find("\n" + key + ":");
  if (at == std::string::npos) return 0;
  return 2 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/// The data of an !!opencv-matrix; empty when it is none. cv::Mat would allocate whatever rows and cols say.
std::vector<double> numbers_of(const cv::FileNode& node) {
  const cv::FileNode rows = node["rows"];
  const cv::FileNode columns = node["cols"];
  const cv::FileNode data = node["data"];
  if (!rows.isInt() || !columns.isInt() || !data.isSeq()) return {};
  if (static_cast<double>(rows) * static_cast<double>(columns) != static_cast<double>(data.size())) return {};
  std::vector<double> numbers;
  for (const cv::FileNode& value : data) {
    if (!value.isInt() && !value.isReal()) return {};
    numbers.push_back(static_cast<double>(value));
  }
  return numbers;
}

CameraModel load_file_storage(const fs::path& file, const std::string& text) {
  const Refuse refuse = [&](const std::string& key, const std::string& found, const std::string& wanted) {
    throw InputError(file, line_of_key(text, key), found, wanted + " for '" + key + "'");
  };
  try {
    const cv::FileStorage storage(
        text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
    Calibration calibration;
    const auto side = [&](const char* key) {
      const cv::FileNode node = storage[key];
      const int value = node.isInt() ? static_cast<int>(node) : 0;
      if (value < 1 || value > max_side_px) refuse(key, "no image side", "a whole number of pixels");
      return value;
    };
    calibration.width_px = side("image_width");
    calibration.height_px = side("image_height");
    calibration.matrix = numbers_of(storage["camera_matrix"]);
    calibration.coefficients = numbers_of(storage["distortion_coefficients"]);
    if (calibration.matrix.size() != 9) refuse("camera_matrix", "no 3 x 3 matrix", "one");
    if (calibration.coefficients.empty()) refuse("distortion_coefficients", "no matrix of numbers", "one");
    if (!std::ranges::all_of(calibration.matrix, [](double v) { return std::isfinite(v); })) {
      refuse("camera_matrix", "a number that is not finite", "finite ones");
    }
    if (!std::ranges::all_of(calibration.coefficients, [](double v) { return std::isfinite(v); })) {
      refuse("distortion_coefficients", "a number that is not finite", "finite ones");
    }
    if (calibration.coefficients.size() == 8) calibration.model = "rational_polynomial";
    return model_of(calibration, refuse);
  } catch (const cv::Exception& error) {
    throw InputError(file, 0, "broken FileStorage YAML (" + error.err + ")", "an OpenCV calibration");
  } catch (const std::logic_error& error) {  // std::length_error and its like escape from OpenCV's parser
    throw InputError(file, 0, std::string("broken FileStorage YAML (") + error.what() + ")",
                     "an OpenCV calibration");
  }
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
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return text.starts_with("%YAML:1.0") ? load_file_storage(file, text) : load_camera_info(file);
}

void save_camera(const CameraModel& camera, const std::string& name, const fs::path& file) {
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
  write_file_atomically(file, text);
}

}  // namespace lodestar
