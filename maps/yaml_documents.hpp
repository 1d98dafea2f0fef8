#pragma once

#include <optional>
#include <string>

namespace lodestar {

/// The line (from 1) where a YAML text goes on after its first document; nothing when it does not. Throws
/// YAML::Exception for a broken text. YAML::LoadAll would tell too, but never returns from some broken texts.
std::optional<int> line_of_second_document(const std::string& text);

}  // namespace lodestar
