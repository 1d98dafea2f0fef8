#include "tests/architecture/method_page.hpp"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

namespace lodestar {
namespace {

namespace fs = std::filesystem;

using Matches = std::cregex_iterator;

Matches matches(std::string_view text, const std::regex& pattern) {
  return {text.data(), text.data() + text.size(), pattern};
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

bool names(const std::string& source, const std::string& symbol) {
  return std::regex_search(source, std::regex("\\b" + symbol + "\\b"));
}

std::vector<std::string> complaints_about_symbol(const NamedSymbol& named, const fs::path& root) {
  if (named.file.empty()) return {named.symbol + " is named without a file"};
  if (!fs::is_regular_file(root / named.file)) return {named.file + " is not there"};
  if (named.symbol.empty() || names(text_of(root / named.file), named.symbol)) return {};
  return {named.symbol + " is not in " + named.file};
}

}  // namespace

std::vector<MethodRow> method_rows(std::string_view page) {
  static const std::regex row{R"(\| \((\d+)\) \|[^|\n]*\|([^|\n]*)\|[^\n]*)"};
  std::vector<MethodRow> rows;
  for (Matches at = matches(page, row), end; at != end; ++at)
    rows.push_back({std::stoi((*at)[1]), (*at)[2], (*at)[0]});
  return rows;
}

std::vector<NamedSymbol> symbols_named_in(std::string_view text) {
  static const std::regex quoted{"`([^`\n]*)`"};
  static const std::regex file{R"([a-z0-9_/]+\.(hpp|cpp))"};
  static const std::regex symbol{"[A-Za-z_][A-Za-z0-9_]*"};
  std::vector<NamedSymbol> named;
  std::string last_file;
  for (Matches at = matches(text, quoted), end; at != end; ++at) {
    const std::string word = (*at)[1];
    if (std::regex_match(word, file)) {
      named.push_back({last_file = word, ""});
    } else if (std::regex_match(word, symbol)) {
      named.push_back({last_file, word});
    }
  }
  return named;
}

std::set<int> equations_named_in(std::string_view source) {
  static const std::regex label{R"((?:Eq\. |and |, |// )\((\d{1,2})\)(?:-\((\d{1,2})\))?)"};
  std::set<int> equations;
  for (Matches at = matches(source, label), end; at != end; ++at) {
    const int first = std::stoi((*at)[1]);
    const int last = (*at)[2].matched ? std::stoi((*at)[2]) : first;
    for (int equation = first; equation <= last; ++equation) equations.insert(equation);
  }
  return equations;
}

std::vector<std::string> complaints_about_row(const MethodRow& row, const fs::path& root) {
  std::vector<std::string> complaints;
  for (const NamedSymbol& named : symbols_named_in(row.text)) {
    for (const std::string& complaint : complaints_about_symbol(named, root)) complaints.push_back(complaint);
  }
  const std::vector<NamedSymbol> homes = symbols_named_in(row.in_the_code);
  const std::string number = std::to_string(row.equation);
  if (std::ranges::all_of(homes, &std::string::empty, &NamedSymbol::symbol))
    complaints.push_back("(" + number + ") has no symbol");
  if (std::ranges::none_of(homes, [&](const NamedSymbol& home) {
        return equations_named_in(text_of(root / home.file)).contains(row.equation);
      })) {
    complaints.push_back("(" + number + ") is named in none of its files");
  }
  return complaints;
}

std::vector<std::string> links_in(std::string_view page) {
  static const std::regex link{R"(\]\(([^)#:]+)\))"};
  std::vector<std::string> targets;
  for (Matches at = matches(page, link), end; at != end; ++at) targets.push_back((*at)[1]);
  return targets;
}

}  // namespace lodestar
