#pragma once

#include <string>

namespace lodestar {

/// A self-contained page around a body of HTML, in the common style, light or dark by the reader's setting.
/// The title is escaped here, the body by the caller. Curves of plots have the classes a, b, c and bound,
/// areas the class band.
std::string page_html(const std::string& title, const std::string& body);

}  // namespace lodestar
