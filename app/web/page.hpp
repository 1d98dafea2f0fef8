#pragma once

#include <string_view>
#include <vector>

namespace lodestar {

/// A file of the console's page, built into the program.
struct PageFile {
  std::string_view target;  ///< the request target: "/", "/app.js"
  std::string_view content_type;
  std::string_view text;
};

/// Empty when the program was built without the page (LODESTAR_WEB=OFF).
const std::vector<PageFile>& page_files();

}  // namespace lodestar
