# Debian packages of what cmake/install.cmake installs: lodestar and liblodestar-dev. script/package sets the variables
# below, and builds without what would only lengthen the list of dependencies.

set(LODESTAR_MAINTAINER "Lodestar developers <lodestar@packages.invalid>" CACHE STRING "Maintainer of the Debian packages")
set(LODESTAR_COMMIT_DATE "Thu, 01 Jan 1970 00:00:00 +0000" CACHE STRING "Date of the commit, as in RFC 5322")
set(LODESTAR_PACKAGE_RELEASE 1)

# Debian wants a package's changelog, the upstream one and the licence beside each other.
set(package_docs ${CMAKE_BINARY_DIR}/package_docs)
configure_file(packaging/debian/changelog.in ${package_docs}/changelog.Debian @ONLY)
configure_file(CHANGELOG.md ${package_docs}/changelog COPYONLY)
find_program(GZIP_PROGRAM gzip REQUIRED)
foreach(file IN ITEMS changelog.Debian changelog)
  execute_process(COMMAND ${GZIP_PROGRAM} -9nkf ${package_docs}/${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
foreach(package IN ITEMS lodestar liblodestar-dev)
  set(component lodestar)
  if(package STREQUAL liblodestar-dev)
    set(component development)
  endif()
  install(FILES ${package_docs}/changelog.Debian.gz ${package_docs}/changelog.gz packaging/debian/copyright
    DESTINATION ${lodestar_docs}/${package} COMPONENT ${component})
  install(FILES packaging/debian/${package}.lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
    COMPONENT ${component} RENAME ${package} OPTIONAL)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "${LODESTAR_MAINTAINER}")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_COMPONENTS_ALL lodestar development)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${LODESTAR_PACKAGE_RELEASE})
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_LODESTAR_PACKAGE_NAME lodestar)
set(CPACK_DEBIAN_LODESTAR_PACKAGE_SECTION science)
set(CPACK_DEBIAN_LODESTAR_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LODESTAR_PACKAGE_DEPENDS adduser)
set(CPACK_DEBIAN_LODESTAR_PACKAGE_SUGGESTS "ffmpeg, poppler-utils")  # videos, plans in PDF
# CPack indents the lines.
set(CPACK_DEBIAN_LODESTAR_DESCRIPTION "indoor navigation for mobile robots under ceiling markers
A camera that looks up sees infrared-retroreflective dot markers on the
ceiling; from them the robot knows where it is to millimetres. It plans its
way over an occupancy map and drives a differential base over CAN.
.
This package has the program with its console for the browser, a service for a
robot, and an example site, the lab, which it drives through in simulation:
lodestar replay.")
set(CPACK_DEBIAN_LODESTAR_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/packaging/debian/postinst"
  "${PROJECT_SOURCE_DIR}/packaging/debian/prerm" "${PROJECT_SOURCE_DIR}/packaging/debian/postrm")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblodestar-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# The libraries are static: what they use must be there to link.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libopencv-core-dev, libopencv-imgproc-dev, \
libopencv-features2d-dev, libopencv-calib3d-dev, libpng-dev, libturbojpeg0-dev, libtiff-dev, libwebp-dev, libexif-dev, \
libfmt-dev, libyaml-cpp-dev, liboctomap-dev, libompl-dev, libceres-dev, libgoogle-glog-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "indoor navigation for mobile robots (libraries)
Headers and static libraries of Lodestar for C++20: maps and markers, the pose
of a camera under ceiling markers, path planning over occupancy maps, and
motion control; with files for CMake's find_package(Lodestar) and examples.")

include(CPack)
