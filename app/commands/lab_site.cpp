#include "app/commands/lab_site.hpp"

namespace lodestar {

std::filesystem::path lab_site() {
  const std::filesystem::path here = std::filesystem::path("sites") / "lab";
  return std::filesystem::exists(here / "site.yaml") ? here
                                                     : std::filesystem::path(LODESTAR_SITES_DIR) / "lab";
}

}  // namespace lodestar
