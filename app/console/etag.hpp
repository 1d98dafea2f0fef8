#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "app/net/http.hpp"

namespace lodestar {

/// ETag of a document: 64-bit FNV-1a of its text, in quotation marks as HTTP requires.
std::string etag_of(std::string_view text);

/// Is this tag among those of an If-Match or If-None-Match? "*" stands for all.
bool has_etag(const std::string& tags, const std::string& etag);

/// The answer with its body's tag.
HttpResponse with_etag(HttpResponse response);

/// The same of a document as JSON; what is no UTF-8 of names that people gave themselves is replaced.
HttpResponse json_document(const nlohmann::ordered_json& content);

/// The refusal to save over the text `present` when the client has not read it; nothing when it has.
std::optional<HttpResponse> conflict_with(const std::string& present, const std::string& if_match);

}  // namespace lodestar
