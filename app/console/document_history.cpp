#include "app/console/document_history.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

#include "app/common/wall_clock.hpp"
#include "maps/atomic_file.hpp"
#include "maps/file_text.hpp"

namespace lodestar {

namespace fs = std::filesystem;

std::vector<int> DocumentHistory::numbers() const {
  std::vector<int> numbers;
  std::error_code none_yet;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, none_yet)) {
    const std::string name = entry.path().stem().string();
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size() && entry.path() == file_of(number)) {
      numbers.push_back(number);
    }
  }
  std::ranges::sort(numbers, std::greater());
  return numbers;
}

std::optional<std::string> DocumentHistory::text(int number) const {
  const std::vector<int> all = numbers();
  if (std::ranges::find(all, number) == all.end()) return std::nullopt;
  return file_text(file_of(number), "an earlier version");
}

int DocumentHistory::keep(const std::string& text) const {
  std::error_code exists;
  fs::create_directories(folder_, exists);
  std::vector<int> all = numbers();
  const int next = all.empty() ? 1 : all.front() + 1;
  write_file_atomically(file_of(next), text);
  for (std::size_t i = most_kept - 1; i < all.size(); ++i) fs::remove(file_of(all[i]));
  return next;
}

std::string DocumentHistory::ended(int number) const {
  std::error_code none;
  const fs::file_time_type time = fs::last_write_time(file_of(number), none);
  return none ? "" : utc_text(std::chrono::file_clock::to_sys(time));
}

fs::path DocumentHistory::file_of(int number) const {
  return folder_ / fmt::format("{:06}.yaml", number);
}

}  // namespace lodestar
