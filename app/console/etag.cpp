#include "app/console/etag.hpp"

#include <cstdint>
#include <fmt/format.h>

#include "app/common/json_text.hpp"

namespace lodestar {

std::string etag_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3U;
  }
  return fmt::format("\"{:016x}\"", hash);
}

bool has_etag(const std::string& tags, const std::string& etag) {
  return tags == "*" || tags.find(etag) != std::string::npos;
}

HttpResponse with_etag(HttpResponse response) {
  response.etag = etag_of(response.body);
  return response;
}

HttpResponse json_document(const nlohmann::ordered_json& content) {
  return with_etag({.body = json_text(content)});
}

std::optional<HttpResponse> conflict_with(const std::string& present, const std::string& if_match) {
  if (if_match.empty()) return refusal(428, "found no If-Match, wanted the tag that was read");
  if (has_etag(if_match, etag_of(present))) return std::nullopt;
  HttpResponse conflict = refusal(412, "another user saved since it was read");
  conflict.etag = etag_of(present);
  return conflict;
}

}  // namespace lodestar
