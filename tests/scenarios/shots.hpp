#pragma once

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "drivers/simulation/image_former.hpp"
#include "maps/paper_camera.hpp"

#include "tests/scenarios/command_line.hpp"

namespace lodestar {

inline std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    rows.push_back(row);
  }
  return rows;
}

/// A folder with a registry, a camera and frames taken straight up at known poses.
class Shots : public ::testing::Test {
 protected:
  Shots() {
    write_text(scratch_.path() / "markers.yaml",
               "format: lodestar-markers\nversion: 1\nalignment: {x_m: 0, y_m: 0, yaw_deg: 0}\nmarkers:\n"
               "  - {id: 447, x_m: 1.0, y_m: 2.0, z_m: 2.6, yaw_deg: 30}\n"
               "  - {id: 1782, x_m: 1.5, y_m: 2.0, z_m: 2.6, yaw_deg: -110}\n");
    save_camera(paper_camera(), "ceiling", scratch_.path() / "camera.yaml");
    std::filesystem::create_directories(scratch_.path() / "frames");
    take("0.5", Pose2{{1.2, 2.1}, radians(75.0)});
    take("1.5", Pose2{{1.3, 1.9}, radians(-160.0)});
  }

  /// The camera's image, 2 m below the markers.
  cv::Mat shot(const Pose2& camera) {
    ImageFormer former(load_registry(scratch_.path() / "markers.yaml"),
                       load_camera(scratch_.path() / "camera.yaml"), SimulatedCameraOptions{}, 1);
    const Eigen::Isometry3d view = lifted(camera, 0.6);
    return former.expose(view, view, frame_++);
  }

  void take(const std::string& name, const Pose2& camera) {
    cv::imwrite((scratch_.path() / "frames" / (name + ".png")).string(), shot(camera));
  }

  Ran run(const std::string& arguments) { return run_lodestar(arguments, scratch_.path()); }

  ScratchFolder scratch_;
  std::uint64_t frame_ = 0;
};

}  // namespace lodestar
