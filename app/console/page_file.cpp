#include "app/console/page_file.hpp"

#include "app/console/etag.hpp"
#include "app/web/page.hpp"

namespace lodestar {

std::optional<HttpResponse> page_file(const std::string& target) {
  for (const PageFile& file : page_files())
    if (file.target == target)
      return with_etag({.content_type = std::string(file.content_type), .body = std::string(file.text)});
  return std::nullopt;
}

}  // namespace lodestar
