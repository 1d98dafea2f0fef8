#include "app/web/page.hpp"

namespace lodestar {

const std::vector<PageFile>& page_files() {
  static const std::vector<PageFile> none;
  return none;
}

}  // namespace lodestar
