# Builds app/web into one .cpp: npm's locked packages once, esbuild on each change of a source. Without Node, or
# where the packages cannot be had, the program is built without the page and says so.

set(LODESTAR_PAGE OFF)
if(LODESTAR_WEB)
  set(web_source ${CMAKE_CURRENT_SOURCE_DIR}/web)
  set(web_packages ${CMAKE_BINARY_DIR}/web)
  find_program(NODE_PROGRAM node)
  find_program(NPM_PROGRAM npm)
  if(NODE_PROGRAM AND NPM_PROGRAM)
    lodestar_npm_packages(${web_source} ${web_packages} LODESTAR_PAGE)
  endif()
  if(NOT LODESTAR_PAGE)
    message(STATUS "Without the console's page: it needs node, npm and the packages of app/web")
  endif()
endif()
set(LODESTAR_PAGE ${LODESTAR_PAGE} CACHE INTERNAL "Is the page in the program?")

if(LODESTAR_PAGE)
  file(GLOB web_files CONFIGURE_DEPENDS ${web_source}/*.ts ${web_source}/*.html ${web_source}/*.css)
  set(page_source ${CMAKE_CURRENT_BINARY_DIR}/embedded_page.cpp)
  add_custom_command(OUTPUT ${page_source}
    COMMAND ${NODE_PROGRAM} ${web_source}/embed.mjs ${web_packages} ${page_source}
    DEPENDS ${web_files} ${web_source}/embed.mjs
    COMMENT "Building the console's page" VERBATIM)
  target_sources(lodestar_app PRIVATE ${page_source})
else()
  target_sources(lodestar_app PRIVATE console/no_page.cpp)
endif()
