# The libraries that `lodestar bench localize` compares with, where they are installed: libapriltag-dev and
# libopencv-contrib-dev. The program does without.

option(LODESTAR_PEERS "Compare with AprilTag and ArUco where they are installed" ON)
if(LODESTAR_PEERS)
  find_path(APRILTAG_INCLUDE_DIR apriltag/apriltag.h)
  find_library(APRILTAG_LIBRARY apriltag)
  find_library(APRILTAG_UTILS_LIBRARY apriltag-utils)  # a part of the former elsewhere
  find_path(ARUCO_INCLUDE_DIR opencv2/aruco.hpp PATH_SUFFIXES opencv4)
  find_library(ARUCO_LIBRARY opencv_aruco)
endif()

# lodestar_peers(TARGET): compiles into the target what is there.
function(lodestar_peers target)
  if(LODESTAR_PEERS AND APRILTAG_INCLUDE_DIR AND APRILTAG_LIBRARY)
    target_sources(${target} PRIVATE apriltag.cpp)
    target_include_directories(${target} SYSTEM PRIVATE ${APRILTAG_INCLUDE_DIR} ${APRILTAG_INCLUDE_DIR}/apriltag)
    target_link_libraries(${target} PRIVATE ${APRILTAG_LIBRARY}
      $<$<BOOL:${APRILTAG_UTILS_LIBRARY}>:${APRILTAG_UTILS_LIBRARY}>)
    target_compile_definitions(${target} PRIVATE LODESTAR_WITH_APRILTAG)
  endif()
  if(LODESTAR_PEERS AND ARUCO_INCLUDE_DIR AND ARUCO_LIBRARY)
    target_sources(${target} PRIVATE aruco.cpp)
    target_include_directories(${target} SYSTEM PRIVATE ${ARUCO_INCLUDE_DIR})
    target_link_libraries(${target} PRIVATE ${ARUCO_LIBRARY} opencv_calib3d)
    target_compile_definitions(${target} PRIVATE LODESTAR_WITH_ARUCO)
  endif()
endfunction()
