# The program's data, found from where the program is (app/common/program_data.hpp): links beside it in the build tree,
# files of the prefix once it is installed.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/lodestar)
foreach(folder IN ITEMS sites faults)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${CMAKE_BINARY_DIR}/share/lodestar/${folder} SYMBOLIC)
endforeach()
