#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

// A reader of docs/method.md, which says where each equation of the paper is in the code.
namespace lodestar {

/// A row of its table: `| (n) | what | in the code | erratum | instead |`.
struct MethodRow {
  int equation = 0;
  std::string in_the_code;  ///< that cell
  std::string text;         ///< the whole row
};

/// In the order of the page.
std::vector<MethodRow> method_rows(std::string_view page);

/// A symbol in backticks and the file, in backticks too, that was named last before it. The symbol is empty
/// for a file after which none is named.
struct NamedSymbol {
  std::string file;
  std::string symbol;
};
std::vector<NamedSymbol> symbols_named_in(std::string_view text);

/// The numbers of the equations that a source's text names, as in `Eq. (4) and (5)`, `Eq. (10)-(15)`, `//
/// (2)`.
std::set<int> equations_named_in(std::string_view source);

/// What of a row is not so: files that are not below `root`, symbols that are not in them, no symbol for the
/// equation, or an equation that none of its files names.
std::vector<std::string> complaints_about_row(const MethodRow& row, const std::filesystem::path& root);

/// The targets of a page's links to other pages.
std::vector<std::string> links_in(std::string_view page);

}  // namespace lodestar
