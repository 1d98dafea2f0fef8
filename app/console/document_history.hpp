#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lodestar {

/// Earlier versions of a document: numbered files in a folder beside it.
class DocumentHistory {
 public:
  static constexpr std::size_t most_kept = 50;

  /// `folder` is created on the first keep().
  explicit DocumentHistory(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Numbers of the versions kept, newest first.
  [[nodiscard]] std::vector<int> numbers() const;

  /// When a version was saved over, in UTC; empty for a number that is not kept.
  [[nodiscard]] std::string ended(int number) const;

  /// Nothing for a number that is not kept.
  [[nodiscard]] std::optional<std::string> text(int number) const;

  /// Keeps a text under the next number, which it returns, and deletes the oldest beyond 50. Throws
  /// InputError when it cannot be written.
  int keep(const std::string& text) const;

 private:
  [[nodiscard]] std::filesystem::path file_of(int number) const;

  std::filesystem::path folder_;
};

}  // namespace lodestar
