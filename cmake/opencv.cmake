# Debian keeps OpenCVConfig.cmake in libopencv-dev, which drags in VTK and MPI. The single libopencv-*-dev packages
# bring headers and libraries only, so each module becomes an imported target here: opencv_core, opencv_imgproc, ...

find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
# No imgcodecs and no videoio: the tests alone use them, as writers that are not ours.
set(lodestar_opencv_modules core imgproc features2d calib3d)
if(LODESTAR_TESTS OR LODESTAR_BENCH)
  list(APPEND lodestar_opencv_modules imgcodecs videoio)
endif()
foreach(module IN LISTS lodestar_opencv_modules)
  find_library(OPENCV_${module}_LIBRARY opencv_${module} REQUIRED)
  add_library(opencv_${module} SHARED IMPORTED GLOBAL)
  set_target_properties(opencv_${module} PROPERTIES
    IMPORTED_LOCATION ${OPENCV_${module}_LIBRARY}
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR}
    INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR})
endforeach()
target_link_libraries(opencv_imgproc INTERFACE opencv_core)
if(TARGET opencv_videoio)
  target_link_libraries(opencv_imgcodecs INTERFACE opencv_imgproc)
  target_link_libraries(opencv_videoio INTERFACE opencv_imgcodecs)
endif()
target_link_libraries(opencv_features2d INTERFACE opencv_imgproc)
target_link_libraries(opencv_calib3d INTERFACE opencv_features2d)

# ChArUco boards need aruco, which Debian ships with all of contrib: used where it is there.
option(LODESTAR_ARUCO "Read ChArUco boards where OpenCV's aruco is installed" ON)
find_library(OPENCV_aruco_LIBRARY opencv_aruco)
if(LODESTAR_ARUCO AND OPENCV_aruco_LIBRARY)
  add_library(opencv_aruco SHARED IMPORTED GLOBAL)
  set_target_properties(opencv_aruco PROPERTIES
    IMPORTED_LOCATION ${OPENCV_aruco_LIBRARY}
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR}
    INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR})
  target_link_libraries(opencv_aruco INTERFACE opencv_calib3d)
endif()
