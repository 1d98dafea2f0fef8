#include <apriltag/apriltag.h>
#include <apriltag/apriltag_pose.h>
#include <apriltag/tag36h11.h>
#include <cstdlib>
#include <fmt/format.h>

#include "app/bench/square_tags.hpp"

namespace lodestar {
namespace {

/// In the library, pixel centres are at half-integer coordinates.
constexpr double half_pixel = 0.5;

struct AprilTagSettings {
  float decimate = 1.0F;
  float sigma = 0.0F;
};

class AprilTag final : public SquareTags {
 public:
  explicit AprilTag(const AprilTagSettings& settings)
      : family_(tag36h11_create()), detector_(apriltag_detector_create()) {
    apriltag_detector_add_family(detector_.get(), family_.get());
    detector_->nthreads = 1;
    detector_->quad_decimate = settings.decimate;
    detector_->quad_sigma = settings.sigma;
    detector_->refine_edges = true;
  }

 private:
  struct Destroy {
    void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
    void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
    void operator()(image_u8_t* image) const { image_u8_destroy(image); }
    void operator()(zarray_t* detections) const { apriltag_detections_destroy(detections); }
    /// A single allocation; Debian's library does not export matd_destroy.
    void operator()(matd_t* matrix) const { std::free(matrix); }
  };

  [[nodiscard]] TagPattern pattern(int id) const override {
    const std::unique_ptr<image_u8_t, Destroy> image(apriltag_to_image(family_.get(), id));
    TagPattern pattern{.modules = image->width};
    for (int v = 0; v < image->height; ++v) {
      for (int u = 0; u < image->width; ++u) pattern.white.push_back(image->buf[v * image->stride + u] > 127);
    }
    return pattern;
  }

  std::vector<TagSighting> find(const cv::Mat& gray) override {
    // With a sigma and without decimation the library blurs its input image in place.
    const bool is_modified = detector_->quad_sigma != 0.0F && detector_->quad_decimate <= 1.0F;
    if (is_modified) gray.copyTo(copy_);
    const cv::Mat& pixels = is_modified ? copy_ : gray;
    image_u8_t image{pixels.cols, pixels.rows, static_cast<int>(pixels.step), pixels.data};
    found_.reset(apriltag_detector_detect(detector_.get(), &image));
    std::vector<TagSighting> tags;
    for (int i = 0; i < zarray_size(found_.get()); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(found_.get(), i, static_cast<void*>(&detection));
      TagSighting& tag =
          tags.emplace_back(TagSighting{.id = detection->id, .index = static_cast<std::size_t>(i)});
      // AprilTag's corners start at the bottom left and go on to the bottom right.
      for (std::size_t k = 0; k < 4; ++k) {
        const auto& corner = detection->p[3 - k];
        tag.corners_px[k] = Vec2(corner[0] - half_pixel, corner[1] - half_pixel);
      }
    }
    return tags;
  }

  [[nodiscard]] std::optional<Eigen::Isometry3d> own_pose(const TagSighting& tag,
                                                          const CameraModel& camera) const override {
    apriltag_detection_t* detection = nullptr;
    zarray_get(found_.get(), static_cast<int>(tag.index), static_cast<void*>(&detection));
    apriltag_detection_info_t info{detection,
                                   tag_side_m,
                                   camera.fx_px,
                                   camera.fy_px,
                                   camera.cx_px + half_pixel,
                                   camera.cy_px + half_pixel};
    apriltag_pose_t pose{};
    estimate_tag_pose(&info, &pose);
    const std::unique_ptr<matd_t, Destroy> rotation(pose.R);
    const std::unique_ptr<matd_t, Destroy> translation(pose.t);
    if (!rotation || !translation) return std::nullopt;
    Eigen::Isometry3d camera_from_tag = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) camera_from_tag.linear()(i, j) = MATD_EL(rotation, i, j);
      camera_from_tag.translation()[i] = MATD_EL(translation, i, 0);
    }
    // AprilTag's y points down on the printed face, and z into it.
    camera_from_tag.linear() = camera_from_tag.linear() * Vec3(1.0, -1.0, -1.0).asDiagonal();
    return camera_from_tag;
  }

  std::unique_ptr<apriltag_family_t, Destroy> family_;
  std::unique_ptr<apriltag_detector_t, Destroy> detector_;
  std::unique_ptr<zarray_t, Destroy> found_;  ///< by the last find()
  cv::Mat copy_;
};

MethodChoice choice(const AprilTagSettings& settings) {
  return {"apriltag",
          fmt::format("tag36h11, decimate {}, sigma {}, edges refined", settings.decimate, settings.sigma),
          [settings] { return std::make_unique<AprilTag>(settings); }};
}

}  // namespace

std::vector<MethodChoice> apriltag_choices() {
  return {choice({.decimate = 1.0F, .sigma = 0.0F}), choice({.decimate = 1.0F, .sigma = 0.8F}),
          choice({.decimate = 2.0F, .sigma = 0.0F})};
}

}  // namespace lodestar
