# The program's data, found from where the program is (app/common/program_data.hpp): links beside it in the build tree,
# files of the prefix once it is installed.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/lodestar)
foreach(folder IN ITEMS sites faults scenarios)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${CMAKE_BINARY_DIR}/share/lodestar/${folder} SYMBOLIC)
endforeach()

# The commit, for pages with figures: a file beside the program, so that a commit does not link everything anew.
add_custom_target(lodestar_commit
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DFILE=${CMAKE_BINARY_DIR}/share/lodestar/commit
    -P ${PROJECT_SOURCE_DIR}/cmake/commit.cmake
  BYPRODUCTS ${CMAKE_BINARY_DIR}/share/lodestar/commit
  COMMENT "Writing down the commit" VERBATIM)
