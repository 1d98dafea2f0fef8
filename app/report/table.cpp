#include "app/report/table.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "app/report/plot.hpp"

namespace lodestar {
namespace {

std::vector<std::size_t> widths_of(const Table& table) {
  std::vector<std::size_t> widths;
  const auto widen = [&](const std::vector<std::string>& row) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  };
  widen(table.header);
  for (const std::vector<std::string>& row : table.rows) widen(row);
  return widths;
}

std::string text_line(const std::vector<std::string>& row, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    line += i == 0 ? fmt::format("  {:<{}}", row[i], widths[i]) : fmt::format("  {:>{}}", row[i], widths[i]);
  }
  return line + "\n";
}

std::string html_row(const std::vector<std::string>& row, const std::string& cell) {
  std::string html = "<tr>";
  for (const std::string& text : row) html += fmt::format("<{0}>{1}</{0}>", cell, escaped(text));
  return html + "</tr>\n";
}

}  // namespace

std::string text_of(const Table& table) {
  const std::vector<std::size_t> widths = widths_of(table);
  std::string text = table.title + "\n" + text_line(table.header, widths);
  for (const std::vector<std::string>& row : table.rows) text += text_line(row, widths);
  return text;
}

std::string html_of(const Table& table) {
  std::string html =
      fmt::format("<h2>{}</h2>\n<table>{}", escaped(table.title), html_row(table.header, "th"));
  for (const std::vector<std::string>& row : table.rows) html += html_row(row, "td");
  return html + "</table>\n";
}

}  // namespace lodestar
