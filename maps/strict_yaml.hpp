#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>
#include <yaml-cpp/yaml.h>

#include "maps/geometry.hpp"

namespace lodestar {

/// A YAML mapping whose keys must all be known, present and of the right type. Read the keys, then call
/// finish(): a key that was not read is an error. All errors are InputErrors with file and line.
class StrictYaml {
 public:
  /// The top-level mapping of a file.
  static StrictYaml load(const std::filesystem::path& file);
  /// The top-level mapping of a text; `file` is only named in error messages.
  static StrictYaml parse(const std::string& text, const std::filesystem::path& file);

  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] double number(const std::string& key);                           ///< finite
  [[nodiscard]] double number(const std::string& key, double low, double high);  ///< in [low, high]
  [[nodiscard]] int integer(const std::string& key, int low, int high);
  [[nodiscard]] bool boolean(const std::string& key);
  [[nodiscard]] std::string text(const std::string& key);  ///< in UTF-8, not empty
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count);
  /// The same of a value below the key, such as an item of a list.
  [[nodiscard]] std::vector<double> numbers_at(const std::string& key, const YAML::Node& list,
                                               std::size_t count) const;
  /// A list of [x, y], both in [-most, most].
  [[nodiscard]] std::vector<Vec2> points(const std::string& key, double most);
  [[nodiscard]] StrictYaml mapping(const std::string& key);
  [[nodiscard]] std::vector<StrictYaml> list_of_mappings(const std::string& key);
  [[nodiscard]] YAML::Node node(const std::string& key);

  /// Throws for the first key that was not read.
  void finish() const;

  /// A key that another program may have written into a file of its own format.
  struct OtherKey {
    std::string name;
    int line = 0;
    std::string yaml;  ///< "name: value"
  };
  /// All keys that were not read; they count as read then.
  [[nodiscard]] std::vector<OtherKey> take_other_keys();

  /// Throws InputError with the line of the given key of this mapping.
  [[noreturn]] void refuse(const std::string& key, const std::string& found, const std::string& wanted) const;

  /// The same with the line of a value below the key.
  [[noreturn]] void refuse_at(const YAML::Node& value, const std::string& found,
                              const std::string& wanted) const;

  [[nodiscard]] int line() const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  StrictYaml(std::filesystem::path file, const YAML::Node& node, std::string where);

  std::filesystem::path file_;
  YAML::Node node_;
  std::string where_;  ///< the path of parents, for messages
  std::set<std::string> asked_;
};

}  // namespace lodestar
