#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lodestar {

/// A document's tag: the same text, the same tag (64 bits of FNV-1a, in quotation marks as HTTP has it).
std::string etag_of(std::string_view text);

/// The whole file. Throws InputError when it cannot be read.
std::string read_document(const std::filesystem::path& file);

/// What a document was before it was last saved, and before that: numbered files in a folder beside it.
class DocumentHistory {
 public:
  static constexpr std::size_t most_kept = 50;

  /// `folder` is made when something is first kept.
  explicit DocumentHistory(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Numbers of what is kept, newest first.
  [[nodiscard]] std::vector<int> numbers() const;

  /// Nothing for a number that is not kept.
  [[nodiscard]] std::optional<std::string> text(int number) const;

  /// Keeps a text under the next number and drops the oldest beyond 50. Throws InputError when it cannot.
  void keep(const std::string& text) const;

 private:
  [[nodiscard]] std::filesystem::path file_of(int number) const;

  std::filesystem::path folder_;
};

}  // namespace lodestar
