#include "maps/strict_yaml.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "maps/file_text.hpp"
#include "maps/input_error.hpp"
#include "maps/utf8.hpp"
#include "maps/yaml_documents.hpp"

namespace lodestar {
namespace {

int line_of(const YAML::Node& node) {
  return node.Mark().is_null() ? 0 : node.Mark().line + 1;
}

std::string kind_of(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Map:
      return "a mapping";
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Scalar:
      return "'" + node.Scalar() + "'";
    default:
      return "nothing";
  }
}

/// yaml-cpp keeps both of two equal keys; here the second is refused.
void refuse_repeated_keys(const std::filesystem::path& file, const YAML::Node& mapping) {
  std::set<std::string> seen;
  for (const auto& entry : mapping) {
    if (!entry.first.IsScalar()) {
      throw InputError(file, line_of(entry.first), kind_of(entry.first) + " as a key", "a word");
    }
    if (!is_utf8(entry.first.Scalar()))
      throw InputError(file, line_of(entry.first), "the key '" + entry.first.Scalar() + "'", "text in UTF-8");
    if (!seen.insert(entry.first.Scalar()).second) {
      throw InputError(file, line_of(entry.first), "a second key '" + entry.first.Scalar() + "'",
                       "each key once");
    }
  }
}

/// A finite decimal number and nothing else: no units, no words, no quotes.
std::optional<double> as_number(const YAML::Node& node) {
  if (!node.IsScalar() || node.Tag() == "!") return std::nullopt;
  const std::string& text = node.Scalar();
  const std::size_t skip = !text.empty() && text.front() == '+' ? 1 : 0;
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data() + skip, text.data() + text.size(), value);
  if (error != std::errc() || rest != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

StrictYaml::StrictYaml(std::filesystem::path file, const YAML::Node& node, std::string where)
    : file_(std::move(file)), node_(node), where_(std::move(where)) {
  if (!node_.IsMap()) {
    const std::string what = where_.empty() ? "a mapping of keys" : "a mapping for " + where_;
    throw InputError(file_, line_of(node_), kind_of(node_), what);
  }
  refuse_repeated_keys(file_, node_);
}

StrictYaml StrictYaml::load(const std::filesystem::path& file) {
  return parse(file_text(file, "a YAML file"), file);
}

StrictYaml StrictYaml::parse(const std::string& text, const std::filesystem::path& file) {
  try {
    const YAML::Node document = YAML::Load(text);
    const std::optional<int> second = line_of_second_document(text);
    if (second) throw InputError(file, *second, "a second document", "one");
    if (document.IsNull()) throw InputError(file, 1, "nothing", "a mapping of keys");
    return {file, document, ""};
  } catch (const YAML::Exception& error) {
    throw InputError(file, error.mark.is_null() ? 0 : error.mark.line + 1, "broken YAML (" + error.msg + ")",
                     "YAML");
  }
}

bool StrictYaml::has(const std::string& key) const {
  return node_[key].IsDefined();
}

YAML::Node StrictYaml::node(const std::string& key) {
  asked_.insert(key);
  const YAML::Node& mapping = node_;  // the const operator[] does not insert
  YAML::Node value = mapping[key];
  if (!value.IsDefined()) {
    throw InputError(file_, line(), "no key '" + key + "'" + (where_.empty() ? "" : " in " + where_), "one");
  }
  return value;
}

double StrictYaml::number(const std::string& key) {
  const YAML::Node value = node(key);
  const std::optional<double> number = as_number(value);
  if (!number) refuse(key, kind_of(value), "a finite number");
  return *number;
}

double StrictYaml::number(const std::string& key, double low, double high) {
  const double value = number(key);
  if (value < low || value > high) refuse(key, fmt::format("{}", value), fmt::format("{} to {}", low, high));
  return value;
}

int StrictYaml::integer(const std::string& key, int low, int high) {
  const YAML::Node value = node(key);
  const std::optional<double> number = as_number(value);
  if (!number || *number != std::floor(*number) || *number < low || *number > high) {
    refuse(key, kind_of(value), fmt::format("a whole number, {} to {}", low, high));
  }
  return static_cast<int>(*number);
}

bool StrictYaml::boolean(const std::string& key) {
  const YAML::Node value = node(key);
  const std::string text = value.IsScalar() ? value.Scalar() : "";
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  refuse(key, kind_of(value), "true or false");
}

std::string StrictYaml::text(const std::string& key) {
  const YAML::Node value = node(key);
  if (!value.IsScalar() || value.Scalar().empty()) refuse(key, kind_of(value), "a word");
  if (!is_utf8(value.Scalar())) refuse(key, kind_of(value), "text in UTF-8");
  return value.Scalar();
}

std::vector<double> StrictYaml::numbers(const std::string& key, std::size_t count) {
  const YAML::Node list = node(key);
  const std::string wanted = fmt::format("a list of {} finite numbers", count);
  if (!list.IsSequence()) refuse(key, kind_of(list), wanted);
  if (list.size() != count) refuse(key, fmt::format("{} values", list.size()), wanted);
  return numbers_at(key, list, count);
}

std::vector<double> StrictYaml::numbers_at(const std::string& key, const YAML::Node& list,
                                           std::size_t count) const {
  const std::string wanted = fmt::format("a list of {} finite numbers", count);
  if (!list.IsSequence()) refuse_at(list, kind_of(list) + " in '" + key + "'", wanted);
  if (list.size() != count) refuse_at(list, fmt::format("{} values in '{}'", list.size(), key), wanted);
  std::vector<double> numbers;
  for (const YAML::Node& item : list) {
    const std::optional<double> number = as_number(item);
    if (!number) refuse_at(item, kind_of(item) + " in '" + key + "'", wanted);
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<Vec2> StrictYaml::points(const std::string& key, double most) {
  const YAML::Node list = node(key);
  const std::string wanted = fmt::format("a list of [x, y] between {} and {}", -most, most);
  if (!list.IsSequence()) refuse(key, kind_of(list), wanted);
  std::vector<Vec2> points;
  for (const YAML::Node& item : list) {
    if (!item.IsSequence() || item.size() != 2) throw InputError(file_, line_of(item), kind_of(item), wanted);
    const std::optional<double> x = as_number(item[0]);
    const std::optional<double> y = as_number(item[1]);
    if (!x || !y || std::abs(*x) > most || std::abs(*y) > most)
      throw InputError(file_, line_of(item), "a malformed point in '" + key + "'", wanted);
    points.emplace_back(*x, *y);
  }
  return points;
}

StrictYaml StrictYaml::mapping(const std::string& key) {
  return {file_, node(key), where_.empty() ? key : where_ + "." + key};
}

std::vector<StrictYaml> StrictYaml::list_of_mappings(const std::string& key) {
  const YAML::Node list = node(key);
  if (!list.IsSequence() && !list.IsNull()) refuse(key, kind_of(list), "a list");
  std::vector<StrictYaml> mappings;
  for (const YAML::Node& item : list) {
    mappings.push_back({file_, item, fmt::format("{}[{}]", key, mappings.size())});
  }
  return mappings;
}

void StrictYaml::finish() const {
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (asked_.contains(key)) continue;
    const std::string place = where_.empty() ? "" : " in " + where_;
    throw InputError(file_, line_of(entry.first), "unknown key '" + key + "'" + place, "only known keys");
  }
}

std::vector<StrictYaml::OtherKey> StrictYaml::take_other_keys() {
  std::vector<OtherKey> others;
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (!asked_.insert(key).second) continue;
    YAML::Emitter yaml;
    yaml << YAML::BeginMap << YAML::Key << entry.first << YAML::Value << entry.second << YAML::EndMap;
    others.push_back({key, line_of(entry.first), yaml.c_str()});
  }
  return others;
}

void StrictYaml::refuse(const std::string& key, const std::string& found, const std::string& wanted) const {
  const YAML::Node value = node_[key];
  const std::string name = where_.empty() ? key : where_ + "." + key;
  throw InputError(file_, value.IsDefined() ? line_of(value) : line(), found, wanted + " for '" + name + "'");
}

void StrictYaml::refuse_at(const YAML::Node& value, const std::string& found,
                           const std::string& wanted) const {
  throw InputError(file_, line_of(value), found, wanted);
}

int StrictYaml::line() const {
  return line_of(node_);
}

}  // namespace lodestar
