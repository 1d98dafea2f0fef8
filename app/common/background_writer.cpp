#include "app/common/background_writer.hpp"

#include <fmt/format.h>

namespace lodestar {

std::string WriterCounts::loss(const std::string& name) const {
  if (complete()) return {};
  const std::size_t missing = dropped + failed;
  const std::string why = error.empty() ? "the disk did not keep up" : error;
  if (missing == 0) return fmt::format("{}: {}", name, why);
  return fmt::format("{}: {} of {} are missing: {}", name, missing, missing + written, why);
}

}  // namespace lodestar
