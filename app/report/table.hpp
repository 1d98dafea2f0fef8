#pragma once

#include <string>
#include <vector>

namespace lodestar {

/// A table of text and numbers: the first column left-aligned, the others right-aligned.
struct Table {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// For a terminal: the title, then columns as wide as their content.
std::string text_of(const Table& table);

/// An <h2> and a <table>; escaped.
std::string html_of(const Table& table);

}  // namespace lodestar
