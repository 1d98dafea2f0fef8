#pragma once

#include <string>
#include <vector>

namespace lodestar {

/// A table of words and figures: the first column flush left, the others flush right.
struct Table {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// For a terminal: the title, then columns as wide as they must be.
std::string text_of(const Table& table);

/// An <h2> and a <table>; escaped.
std::string html_of(const Table& table);

}  // namespace lodestar
