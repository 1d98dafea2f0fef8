#pragma once

#include <optional>
#include <string>

namespace lodestar {

/// The line (from 1) at which a second document of a YAML text begins; empty when there is none. Throws
/// YAML::Exception for malformed text. YAML::LoadAll would find it too, but never returns for some malformed
/// texts.
std::optional<int> line_of_second_document(const std::string& text);

}  // namespace lodestar
