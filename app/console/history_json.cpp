#include "app/console/history_json.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

#include "app/common/percent_decoding.hpp"

namespace lodestar {

nlohmann::ordered_json history_json(const DocumentHistory& history, const AuditLog& audit,
                                    const std::string& document) {
  nlohmann::ordered_json states = nlohmann::ordered_json::array();
  for (const int number : history.numbers())
    states.push_back(
        {{"number", number}, {"at", history.ended(number)}, {"by", audit.author_of(document, number)}});
  return states;
}

std::string name_of(const HttpRequest& request) {
  constexpr std::size_t longest = 40;
  std::string name = percent_decoded(request.client_name).value_or("");
  std::erase_if(name, [](unsigned char letter) { return letter < ' ' || letter == 0x7F; });
  if (name.size() <= longest) return name;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;  // not within a letter
  return name.substr(0, end);
}

std::string changes_in_words(const MarkerRegistry& before, const MarkerRegistry& after) {
  std::map<int, const RegisteredMarker*> former;
  for (const RegisteredMarker& marker : before.markers) former[marker.id] = &marker;
  int changed = 0;
  int added = 0;
  for (const RegisteredMarker& marker : after.markers) {
    const auto found = former.find(marker.id);
    if (found == former.end()) {
      ++added;
      continue;
    }
    const RegisteredMarker& was = *found->second;
    if (was.position_m != marker.position_m || was.yaw_rad != marker.yaw_rad) ++changed;
    former.erase(found);
  }
  return fmt::format("{} changed, {} added, {} removed", changed, added, former.size());
}

}  // namespace lodestar
