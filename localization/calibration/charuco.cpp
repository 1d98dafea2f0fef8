#include "localization/calibration/charuco.hpp"

#include <algorithm>

#include "maps/input_error.hpp"

#ifdef LODESTAR_ARUCO
#include <array>
#include <opencv2/aruco/charuco.hpp>
#include <utility>
#endif

namespace lodestar {

#ifdef LODESTAR_ARUCO
namespace {

constexpr std::array<std::pair<const char*, cv::aruco::PREDEFINED_DICTIONARY_NAME>, 17> dictionaries{
    {{"DICT_4X4_50", cv::aruco::DICT_4X4_50},
     {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
     {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
     {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
     {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
     {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
     {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
     {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
     {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
     {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
     {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
     {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
     {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
     {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
     {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
     {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
     {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL}}};

cv::Ptr<cv::aruco::Dictionary> dictionary_of(const std::string& name) {
  const auto* const found =
      std::ranges::find_if(dictionaries, [&](const auto& entry) { return name == entry.first; });
  if (found == dictionaries.end()) {
    throw InputError("--dictionary: found '" + name + "', wanted one such as DICT_4X4_50 or DICT_5X5_100");
  }
  return cv::aruco::getPredefinedDictionary(found->second);
}

bool are_on_one_line(const std::vector<cv::Point3f>& points) {
  const auto same = [&](auto coordinate) {
    return std::ranges::all_of(points,
                               [&](const cv::Point3f& p) { return p.*coordinate == points[0].*coordinate; });
  };
  return same(&cv::Point3f::x) || same(&cv::Point3f::y);
}

}  // namespace

std::optional<BoardView> find_charuco_board(const cv::Mat& gray, const CalibrationBoard& board) {
  const auto dictionary = dictionary_of(board.dictionary);
  const auto layout =
      cv::aruco::CharucoBoard::create(board.columns, board.rows, static_cast<float>(board.square_m),
                                      static_cast<float>(board.marker_m), dictionary);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<std::vector<cv::Point2f>> rejected;
  std::vector<int> ids;
  const auto parameters = cv::aruco::DetectorParameters::create();
  cv::aruco::detectMarkers(gray, dictionary, markers, ids, parameters, rejected);
  if (ids.empty()) return std::nullopt;
  cv::aruco::refineDetectedMarkers(gray, layout, markers, ids, rejected);

  BoardView view;
  std::vector<int> corner_ids;
  cv::aruco::interpolateCornersCharuco(markers, ids, gray, layout, view.pixels, corner_ids);
  for (const int id : corner_ids) {
    view.points_m.push_back(layout->chessboardCorners[static_cast<std::size_t>(id)]);
  }
  constexpr std::size_t least_corners = 8;
  if (view.pixels.size() < least_corners || are_on_one_line(view.points_m)) return std::nullopt;
  return view;
}

#else

std::optional<BoardView> find_charuco_board(const cv::Mat&, const CalibrationBoard&) {
  throw InputError(
      "--board charuco: found a build without OpenCV's aruco module, wanted one with it "
      "(libopencv-contrib-dev)");
}

#endif

}  // namespace lodestar
