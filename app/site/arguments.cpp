#include "app/site/arguments.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>
#include <utility>
#include <vector>

#include "maps/input_error.hpp"

namespace lodestar {
namespace {

/// The finite numbers between the commas; nothing when a part is no such number.
std::optional<std::vector<double>> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    double number = 0.0;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
    if (rest == end) return numbers;
    if (*rest != ',') return std::nullopt;
    at = rest + 1;
  }
}

/// How many letters must be put in, taken out or replaced to make one word of the other (Levenshtein 1966),
/// whether capital or not.
std::size_t edits_between(const std::string& a, const std::string& b) {
  const auto small = [](char letter) { return std::tolower(static_cast<unsigned char>(letter)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t replaced = diagonal + (small(a[i]) == small(b[k]) ? 0 : 1);
      diagonal = row[k + 1];
      row[k + 1] = std::min({replaced, row[k] + 1, row[k + 1] + 1});
    }
  }
  return row.back();
}

/// Names of places, those spelt most like the given one first.
std::string nearest_names(const std::string& name, const Places& places) {
  constexpr std::size_t most = 3;
  std::vector<std::string> names;
  for (const Place& place : places.places) names.push_back(place.name);
  std::ranges::stable_sort(names, {}, [&](const std::string& known) { return edits_between(name, known); });
  names.resize(std::min(names.size(), most));
  return fmt::format("'{}'", fmt::join(names, "', '"));
}

}  // namespace

Vec2 parse_point(const std::string& option, const std::string& text) {
  const auto numbers = numbers_in(text);
  if (!numbers || numbers->size() != 2) {
    throw InputError(fmt::format("{}: found '{}', wanted X,Y in metres", option, text));
  }
  return {(*numbers)[0], (*numbers)[1]};
}

Goal parse_goal(const std::string& option, const std::string& text) {
  const auto numbers = numbers_in(text);
  if (!numbers || numbers->size() < 2 || numbers->size() > 3) {
    throw InputError(
        fmt::format("{}: found '{}', wanted X,Y or X,Y,DEG in metres and degrees", option, text));
  }
  Goal goal{{(*numbers)[0], (*numbers)[1]}, std::nullopt};
  if (numbers->size() == 3) goal.heading_rad = wrap_angle(radians((*numbers)[2]));
  return goal;
}

Goal parse_goal(const std::string& option, const std::string& text, const Places& places) {
  if (const Place* const place = places.find(text)) return {place->position_m, place->yaw_rad};
  const bool is_name = !text.empty() && !numbers_in(text);
  if (!is_name || places.places.empty()) return parse_goal(option, text);
  throw InputError(
      fmt::format("{}: found '{}', wanted X,Y or X,Y,DEG in metres and degrees or a place such as {}", option,
                  text, nearest_names(text, places)));
}

std::vector<Goal> goals_of(const NamedMission& mission, const Places& places) {
  std::vector<Goal> goals;
  for (const MissionStop& stop : mission.stops) {
    Goal goal = parse_goal("--mission", stop.place, places);
    goal.wait = from_seconds(stop.wait_s);
    goal.action = stop.action;
    goals.push_back(std::move(goal));
  }
  return goals;
}

std::vector<Goal> goals_in(const std::vector<std::string>& goals, const std::string& mission,
                           const Places& places) {
  std::vector<Goal> all;
  for (const std::string& text : goals) all.push_back(parse_goal("--goal", text, places));
  if (mission.empty()) return all;
  const auto named = std::ranges::find(places.missions, mission, &NamedMission::name);
  if (named == places.missions.end()) {
    std::string names;
    for (const NamedMission& known : places.missions)
      names += fmt::format("{}'{}'", names.empty() ? "" : ", ", known.name);
    throw InputError(fmt::format("--mission: found '{}', wanted a mission of places.yaml: {}", mission,
                                 names.empty() ? "it has none" : names));
  }
  const std::vector<Goal> once = goals_of(*named, places);
  for (int i = 0; i < named->repeat; ++i) all.insert(all.end(), once.begin(), once.end());
  return all;
}

}  // namespace lodestar
