#include "app/bench/evidence.hpp"

#include <algorithm>
#include <fmt/ranges.h>

#include "app/common/program_data.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& arguments_of(const EvidencePart& part, bool quick) {
  return quick ? part.quick_arguments : part.arguments;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at != std::string::npos) text.replace(at, what.size(), by);
  return text;
}

std::string number_with_unit(double value, const std::string& unit) {
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::vector<EvidenceRow> rows_without_figures(const EvidencePart& part, EvidenceStanding standing,
                                              const std::string& why) {
  std::vector<EvidenceRow> rows;
  for (const std::string& promise : part.promises)
    rows.push_back({.what = promise, .standing = standing, .why = why});
  return rows;
}

/// A rate or a ratio of few trials is chance; a single contact is none.
EvidenceStanding by_few_trials(const EvidenceRow& row) {
  const bool is_figure = row.standing == EvidenceStanding::kept || row.standing == EvidenceStanding::missed;
  const bool is_broken = row.standing == EvidenceStanding::missed && row.one_case_breaks_it;
  return is_figure && !is_broken ? EvidenceStanding::not_judged : row.standing;
}

bool is_bad(const EvidenceRow& row) {
  return row.standing == EvidenceStanding::failed || row.standing == EvidenceStanding::missed;
}

std::string with_last_words(const std::string& why, const ProgramEnd& end) {
  return end.last_words.empty() ? why : fmt::format("{}: {}", why, end.last_words);
}

/// Exit 1 of a bench means that a limit is missed: its figures are there all the same.
std::vector<EvidenceRow> rows_of(const EvidencePart& part, const ProgramEnd& end) {
  constexpr int limit_missed = 1;
  if (!end.exit_code)
    return rows_without_figures(part, EvidenceStanding::failed, with_last_words(end.why, end));
  const std::string exit = fmt::format("exit code {}", *end.exit_code);
  if (*end.exit_code > limit_missed)
    return rows_without_figures(part, EvidenceStanding::failed, with_last_words(exit, end));
  std::vector<EvidenceRow> rows;
  try {
    rows = part.read(end.output);
  } catch (const std::exception& error) {
    const std::string why = *end.exit_code == 0
                                ? fmt::format("its output could not be read ({})", error.what())
                                : with_last_words(exit, end);
    return rows_without_figures(part, EvidenceStanding::failed, why);
  }
  if (rows.empty()) return rows_without_figures(part, EvidenceStanding::failed, "its output has no figures");
  if (*end.exit_code != 0 && std::ranges::none_of(rows, is_bad))
    rows.push_back({.what = "the command's own verdict",
                    .standing = EvidenceStanding::missed,
                    .why = with_last_words(exit, end)});
  return rows;
}

}  // namespace

std::string to_string(EvidenceStanding standing) {
  switch (standing) {
    case EvidenceStanding::kept:
      return "kept";
    case EvidenceStanding::missed:
      return "missed";
    case EvidenceStanding::measured:
      return "measured";
    case EvidenceStanding::not_judged:
      return "not judged";
    case EvidenceStanding::failed:
      return "failed";
    case EvidenceStanding::not_possible:
      return "not possible";
    case EvidenceStanding::left_out:
      return "left out";
  }
  return "";
}

EvidenceRow at_most(const std::string& what, double value, double limit, const std::string& unit) {
  return {.what = what,
          .today = number_with_unit(value, unit),
          .limit = fmt::format("at most {}", number_with_unit(limit, unit)),
          .standing = value <= limit ? EvidenceStanding::kept : EvidenceStanding::missed,
          .one_case_breaks_it = limit == 0.0};
}

EvidenceRow at_least(const std::string& what, double value, double limit, const std::string& unit) {
  return {.what = what,
          .today = number_with_unit(value, unit),
          .limit = fmt::format("at least {}", number_with_unit(limit, unit)),
          .standing = value >= limit ? EvidenceStanding::kept : EvidenceStanding::missed};
}

bool Evidence::holds() const {
  return std::ranges::none_of(
      sections, [](const EvidenceSection& section) { return std::ranges::any_of(section.rows, is_bad); });
}

EvidenceSection gather(const EvidencePart& part, bool quick, const RunPart& run) {
  const fs::path needed = part.needs.empty() ? fs::path() : program_data(part.needs);
  std::error_code cannot;
  if (!part.needs.empty() && !fs::exists(needed, cannot))
    return without_figures(part, quick, EvidenceStanding::not_possible,
                           fmt::format("{} is not there", part.needs));
  std::vector<std::string> arguments = arguments_of(part, quick);
  for (std::string& word : arguments) word = replaced(word, "{needs}", needed.string());

  const ProgramEnd end = run(part, arguments);
  EvidenceSection section = without_figures(part, quick, EvidenceStanding::failed, "");
  section.wall_s = end.wall_s;
  section.rows = rows_of(part, end);
  if (quick)
    for (EvidenceRow& row : section.rows) row.standing = by_few_trials(row);
  return section;
}

EvidenceSection without_figures(const EvidencePart& part, bool quick, EvidenceStanding standing,
                                const std::string& why) {
  std::string command = part.program;
  for (const std::string& word : arguments_of(part, quick))
    command += fmt::format(" {}", replaced(replaced(word, "{needs}", part.needs), "{folder}", "evidence"));
  return {.part = part, .command = command, .rows = rows_without_figures(part, standing, why)};
}

}  // namespace lodestar
