#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/common/child_program.hpp"
#include "app/common/machine.hpp"

// `bench all`: every promise with today's figure, by running the commands that anybody can run.
namespace lodestar {

/// How a promise stands today.
enum class EvidenceStanding {
  kept,
  missed,
  measured,      ///< a figure without a limit
  not_judged,    ///< by too few trials to say so (--quick)
  failed,        ///< the command failed, or its output could not be read
  not_possible,  ///< here: something that it needs is not there
  left_out,      ///< not asked for, or interrupted before
};
std::string to_string(EvidenceStanding standing);

struct EvidenceRow {
  std::string what;
  std::string today;  ///< with its unit
  std::string limit;  ///< empty: none is promised
  std::string peer;   ///< measured in the same run; empty: there is none
  EvidenceStanding standing = EvidenceStanding::measured;
  std::string why;                  ///< where there is no figure
  bool one_case_breaks_it = false;  ///< of wrong or harmful cases none is allowed, in however few trials
};

/// A figure against its limit.
EvidenceRow at_most(const std::string& what, double value, double limit, const std::string& unit);
EvidenceRow at_least(const std::string& what, double value, double limit, const std::string& unit);

/// One command, and what it is evidence of. In its arguments, `{needs}` stands for the file or folder that it
/// needs, and `{folder}` for one that it may write.
struct EvidencePart {
  std::string name;
  std::string title;
  std::string program = "lodestar";  ///< or a benchmark beside it
  std::vector<std::string> arguments;
  std::vector<std::string> quick_arguments;  ///< instead, in seconds rather than minutes
  std::string needs;                         ///< below the working directory, or of the program's data
  std::vector<std::string> promises;         ///< a row each when there are no figures
  /// Throws std::exception for an output that it cannot read.
  std::function<std::vector<EvidenceRow>(const std::string& output)> read;
  std::string conclude;      ///< what a reader may
  std::string not_conclude;  ///< and what not
};

struct EvidenceSection {
  EvidencePart part;
  std::string command;  ///< as it is typed
  double wall_s = 0.0;
  std::vector<EvidenceRow> rows;
};

struct Evidence {
  std::string version;
  std::string date;  ///< UTC
  bool quick = false;
  Machine machine;
  Build build;
  std::vector<EvidenceSection> sections;

  /// No row failed or missed its limit.
  [[nodiscard]] bool holds() const;
};

/// Runs a part's program with these arguments.
using RunPart = std::function<ProgramEnd(const EvidencePart&, const std::vector<std::string>& arguments)>;

/// One part, run and read. Whatever happens, it has a row at least, and says what happened.
EvidenceSection gather(const EvidencePart& part, bool quick, const RunPart& run);

/// A part that is not run: its promises, each with the reason.
EvidenceSection without_figures(const EvidencePart& part, bool quick, EvidenceStanding standing,
                                const std::string& why);

}  // namespace lodestar
