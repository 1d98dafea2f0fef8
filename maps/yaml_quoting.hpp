#pragma once

#include <string>

namespace lodestar {

/// Text in double quotes, as YAML reads it back.
std::string yaml_quoted(const std::string& text);

}  // namespace lodestar
