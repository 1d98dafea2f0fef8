#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

// A parser of docs/method.md, which says where each equation of the paper is in the code.
namespace lodestar {

/// A row of its table: `| (n) | what | in the code | erratum | instead |`.
struct MethodRow {
  int equation = 0;
  std::string in_the_code;  ///< that cell
  std::string text;         ///< the whole row
};

/// In the order of the page.
std::vector<MethodRow> method_rows(std::string_view page);

/// A symbol in backticks, and the file named last before it, also in backticks. The symbol is empty for a
/// file without one.
struct NamedSymbol {
  std::string file;
  std::string symbol;
};
std::vector<NamedSymbol> symbols_named_in(std::string_view text);

/// The equation numbers that a source's text names, as in `// (2)`, `Eq. (4) and (5)`, `Eq. (10)-(15)`.
std::set<int> equations_named_in(std::string_view source);

/// Errors in a row: files that are not below `root`, symbols that are not in them, no symbol for the
/// equation, or an equation that none of its files names.
std::vector<std::string> complaints_about_row(const MethodRow& row, const std::filesystem::path& root);

/// The targets of a page's links to other pages.
std::vector<std::string> links_in(std::string_view page);

}  // namespace lodestar
