#pragma once

#include <string>

namespace lodestar {

/// A whole self-contained page: the house's look, light or dark as the reader has it, around a body of HTML.
/// The title is escaped here, the body by whoever wrote it. Curves of plots have the classes a, b, c and
/// bound, areas the class band.
std::string page_html(const std::string& title, const std::string& body);

}  // namespace lodestar
