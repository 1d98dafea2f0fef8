#include "maps/movingai_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "maps/input_error.hpp"
#include "maps/path_kind.hpp"

namespace lodestar {
namespace {

/// The lines of a text file one after the other, with their numbers.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : file_(file), stream_(file) {
    if (!stream_ || is_folder(file)) refuse("no readable file", "a text file");
  }

  bool next() {
    ++number_;
    if (!std::getline(stream_, line_)) return false;
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    return true;
  }

  /// The next line; the file must have one.
  const std::string& require(const std::string& wanted) {
    if (!next()) refuse("the end of the file", wanted);
    return line_;
  }

  [[nodiscard]] const std::string& line() const { return line_; }
  [[noreturn]] void refuse(const std::string& found, const std::string& wanted) const {
    throw InputError(file_, number_, found, wanted);
  }

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::string line_;
  int number_ = 0;
};

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// The whole word as a number; empty when it is not one.
template <typename Number>
std::optional<Number> number_in(const std::string& word) {
  Number number{};
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || rest != word.data() + word.size()) return std::nullopt;
  return number;
}

int read_size(Lines& lines, const std::string& key) {
  constexpr int largest = 30000;
  const std::string wanted = fmt::format("'{} N' with N from 1 to {}", key, largest);
  const std::vector<std::string> words = words_of(lines.require(wanted));
  const std::optional<int> size =
      words.size() == 2 && words[0] == key ? number_in<int>(words[1]) : std::nullopt;
  if (!size || *size < 1 || *size > largest) lines.refuse(fmt::format("'{}'", lines.line()), wanted);
  return *size;
}

void expect_line(Lines& lines, const std::string& wanted) {
  if (lines.require(fmt::format("'{}'", wanted)) != wanted) {
    lines.refuse(fmt::format("'{}'", lines.line()), fmt::format("'{}'", wanted));
  }
}

std::int8_t occupancy_of(char terrain, const Lines& lines) {
  constexpr std::string_view passable = ".GS";
  constexpr std::string_view solid = "@OTW";
  if (passable.find(terrain) != std::string_view::npos) return OccupancyMap::free;
  if (solid.find(terrain) != std::string_view::npos) return OccupancyMap::occupied;
  lines.refuse(fmt::format("terrain {:?}", terrain), "one of . G S @ O T W");
}

int read_coordinate(const std::string& word, const Lines& lines) {
  const std::optional<int> number = number_in<int>(word);
  if (!number) lines.refuse(fmt::format("'{}'", word), "a whole number");
  return *number;
}

Cell read_cell(const std::vector<std::string>& words, std::size_t at, const OccupancyMap& map,
               const Lines& lines) {
  const Cell cell{read_coordinate(words[at], lines), read_coordinate(words[at + 1], lines)};
  if (!map.contains(cell) || !is_drivable(map.at(cell))) {
    lines.refuse(fmt::format("{} {}", cell.column, cell.row), "a free cell of the map");
  }
  return cell;
}

/// Half a unit of the last digit. Some files print six digits and drop zeros at the end.
double rounding_of(const std::string& printed, double length) {
  constexpr int least_digits = 6;
  const std::size_t point = printed.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(printed.size() - point) - 1;
  const int before_point = length < 1.0 ? 0 : 1 + static_cast<int>(std::floor(std::log10(length)));
  return 0.5 * std::pow(10.0, -std::max(decimals, least_digits - before_point));
}

/// bucket, map, width, height, start x and y, goal x and y, length
MovingAiQuery read_query(const OccupancyMap& map, const Lines& lines) {
  constexpr std::size_t fields = 9;
  const std::vector<std::string> words = words_of(lines.line());
  if (words.size() != fields) lines.refuse(fmt::format("{} fields", words.size()), "9 fields");
  const Cell size{read_coordinate(words[2], lines), read_coordinate(words[3], lines)};
  if (size != Cell{map.columns, map.rows}) {
    lines.refuse(fmt::format("a map of {} x {}", size.column, size.row),
                 fmt::format("{} x {} as in the map", map.columns, map.rows));
  }
  const std::optional<double> length = number_in<double>(words[8]);
  if (!length || !std::isfinite(*length) || *length < 0.0) {
    lines.refuse(fmt::format("length '{}'", words[8]), "a number of at least 0");
  }
  return {read_cell(words, 4, map, lines), read_cell(words, 6, map, lines), *length,
          rounding_of(words[8], *length)};
}

}  // namespace

OccupancyMap load_movingai_map(const std::filesystem::path& file) {
  Lines lines(file);
  expect_line(lines, "type octile");
  OccupancyMap map;
  map.rows = read_size(lines, "height");
  map.columns = read_size(lines, "width");
  map.resolution_m = 1.0;
  expect_line(lines, "map");
  for (int row = 0; row < map.rows; ++row) {
    const std::string& line = lines.require(fmt::format("{} rows of terrain", map.rows));
    if (line.size() != static_cast<std::size_t>(map.columns)) {
      lines.refuse(fmt::format("{} cells", line.size()), fmt::format("{}, the map's width", map.columns));
    }
    for (const char terrain : line) map.cells.push_back(occupancy_of(terrain, lines));
  }
  return map;
}

std::vector<MovingAiQuery> load_movingai_queries(const std::filesystem::path& file, const OccupancyMap& map) {
  Lines lines(file);
  const std::vector<std::string> version = words_of(lines.require("'version 1'"));
  if (version.size() != 2 || version[0] != "version" || number_in<double>(version[1]) != 1.0) {
    lines.refuse(fmt::format("'{}'", lines.line()), "'version 1'");
  }
  std::vector<MovingAiQuery> queries;
  while (lines.next()) {
    if (!lines.line().empty()) queries.push_back(read_query(map, lines));
  }
  return queries;
}

}  // namespace lodestar
