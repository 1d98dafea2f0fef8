# find_package(Lodestar): the targets Lodestar::maps, Lodestar::localization (or one of its rooms: detection, pose, ceiling,
# filter, scan, integrity, calibration, survey), Lodestar::planning and Lodestar::control.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
find_dependency(fmt)
find_dependency(yaml-cpp)
find_dependency(octomap)
# OpenCV's own targets where all of it is installed; else, those of the modules that are used.
find_package(OpenCV QUIET COMPONENTS core imgproc features2d calib3d)
if(NOT TARGET opencv_core)
  include(${CMAKE_CURRENT_LIST_DIR}/opencv.cmake)
endif()
include(${CMAKE_CURRENT_LIST_DIR}/LodestarTargets.cmake)
