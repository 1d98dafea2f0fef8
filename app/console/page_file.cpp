#include "app/console/page_file.hpp"

#include "app/console/document_history.hpp"
#include "app/web/page.hpp"

namespace lodestar {

std::optional<HttpResponse> page_file(const std::string& target) {
  for (const PageFile& file : page_files()) {
    if (file.target != target) continue;
    HttpResponse response{.content_type = std::string(file.content_type), .body = std::string(file.text)};
    response.etag = etag_of(response.body);
    return response;
  }
  return std::nullopt;
}

}  // namespace lodestar
