#pragma once

#include <optional>
#include <string>

#include "app/net/http.hpp"

namespace lodestar {

/// A file of the page, with its ETag; nothing for another target.
std::optional<HttpResponse> page_file(const std::string& target);

}  // namespace lodestar
