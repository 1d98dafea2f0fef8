#include <fmt/format.h>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>

#include "app/bench/square_tags.hpp"

namespace lodestar {
namespace {

namespace aruco = cv::aruco;

struct ArucoSettings {
  int refinement = aruco::CORNER_REFINE_SUBPIX;
  int window_px = 5;  ///< of the sub-pixel refinement, to each side
};

class Aruco final : public SquareTags {
 public:
  explicit Aruco(const ArucoSettings& settings)
      : dictionary_(aruco::getPredefinedDictionary(aruco::DICT_4X4_50)),
        parameters_(aruco::DetectorParameters::create()),
        offset_px_(settings.refinement == aruco::CORNER_REFINE_APRILTAG ? 0.5 : 0.0) {
    parameters_->cornerRefinementMethod = settings.refinement;
    parameters_->cornerRefinementWinSize = settings.window_px;
    parameters_->cornerRefinementMaxIterations = 50;
    parameters_->cornerRefinementMinAccuracy = 0.01;
  }

 private:
  [[nodiscard]] TagPattern pattern(int id) const override {
    const int inner = dictionary_->markerSize + 2;  // with the black frame
    cv::Mat image;
    aruco::drawMarker(dictionary_, id, inner, image, 1);
    TagPattern pattern{.modules = inner + 2};
    for (int v = -1; v <= inner; ++v) {
      for (int u = -1; u <= inner; ++u) {
        const bool is_margin = u < 0 || v < 0 || u == inner || v == inner;
        pattern.white.push_back(is_margin || image.at<std::uint8_t>(v, u) > 127);
      }
    }
    return pattern;
  }

  std::vector<TagSighting> find(const cv::Mat& gray) override {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    aruco::detectMarkers(gray, dictionary_, corners, ids, parameters_);
    std::vector<TagSighting> tags;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      TagSighting& tag = tags.emplace_back(TagSighting{.id = ids[i], .index = i});
      for (std::size_t k = 0; k < 4; ++k)
        tag.corners_px[k] = Vec2(corners[i][k].x - offset_px_, corners[i][k].y - offset_px_);
    }
    return tags;
  }

  /// IPPE for squares (Collins and Bartoli 2014): the better of its two poses.
  [[nodiscard]] std::optional<Eigen::Isometry3d> own_pose(const TagSighting& tag,
                                                          const CameraModel& camera) const override {
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> pixels;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 point = tag_corners()[k];
      points.emplace_back(point.x(), point.y(), point.z());
      pixels.emplace_back(tag.corners_px[k].x(), tag.corners_px[k].y());
    }
    const cv::Matx33d intrinsics(camera.fx_px, 0.0, camera.cx_px, 0.0, camera.fy_px, camera.cy_px, 0.0, 0.0,
                                 1.0);
    cv::Vec3d turn;
    cv::Vec3d translation;
    if (!cv::solvePnP(points, pixels, intrinsics, cv::noArray(), turn, translation, false,
                      cv::SOLVEPNP_IPPE_SQUARE)) {
      return std::nullopt;
    }
    cv::Matx33d rotation;
    cv::Rodrigues(turn, rotation);
    Eigen::Isometry3d camera_from_tag = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) camera_from_tag.linear()(i, j) = rotation(i, j);
      camera_from_tag.translation()[i] = translation[i];
    }
    return camera_from_tag;
  }

  cv::Ptr<aruco::Dictionary> dictionary_;
  cv::Ptr<aruco::DetectorParameters> parameters_;
  /// Corners refined by AprilTag's lines keep its convention of half-integer pixel centres.
  double offset_px_;
};

MethodChoice choice(const std::string& refinement, const ArucoSettings& settings) {
  return {"aruco", fmt::format("4x4_50, corners refined by {}", refinement),
          [settings] { return std::make_unique<Aruco>(settings); }};
}

}  // namespace

std::vector<MethodChoice> aruco_choices() {
  return {choice("sub-pixel search, 5 px", {aruco::CORNER_REFINE_SUBPIX, 5}),
          choice("sub-pixel search, 3 px", {aruco::CORNER_REFINE_SUBPIX, 3}),
          choice("contour", {aruco::CORNER_REFINE_CONTOUR, 5}),
          choice("AprilTag's lines", {aruco::CORNER_REFINE_APRILTAG, 5})};
}

}  // namespace lodestar
