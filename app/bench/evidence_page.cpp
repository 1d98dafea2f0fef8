#include "app/bench/evidence_page.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "app/report/page.hpp"
#include "app/report/plot.hpp"

namespace lodestar {
namespace {

constexpr std::array all_standings{EvidenceStanding::kept,       EvidenceStanding::missed,
                                   EvidenceStanding::not_judged, EvidenceStanding::measured,
                                   EvidenceStanding::failed,     EvidenceStanding::not_possible,
                                   EvidenceStanding::left_out};

constexpr const char* style_of_standings = R"(<style>
td.text { text-align: left; } td.why { color: var(--soft); }
td:nth-child(1) { width: 34%; } td.short { white-space: nowrap; } code { font-size: .9em; } p.command { margin: .2rem 0; overflow-wrap: anywhere; }
tr.missed td.standing, tr.failed td.standing { color: var(--b); font-weight: 600; }
tr.kept td.standing { color: var(--c); } ul { margin: .4rem 0; padding-left: 1.2rem; }
</style>
)";

struct Elsewhere {
  const char* what;
  const char* command;
};

/// Promises whose measurement needs what this command may not take: root, a browser, a kernel, a robot.
constexpr std::array<Elsewhere, 7> measured_elsewhere{{
    {"Zero command on the bus after the navigator dies or hangs; reaction to each fault of a base",
     "script/measure-faults"},
    {"The same faults as tests, on a kernel with its own CAN", "script/test-can"},
    {"A stop pressed in the browser while the server computes", "script/test-web"},
    {"Files saved whole whenever the program is killed", "script/kill"},
    {"Memory, descriptors and control period over hours", "script/soak 60 4"},
    {"Debian packages: installed, replayed and purged in a fresh root",
     "tests/package/fresh_root build/package/packages"},
    {"A real robot under real markers", "nothing: no such figure exists"},
}};

std::string body_row(const EvidenceRow& row) {
  const std::string standing = to_string(row.standing);
  std::string css_class = standing;
  std::ranges::replace(css_class, ' ', '-');
  const std::string today =
      row.why.empty() ? fmt::format("<td class=\"short\">{}</td><td>{}</td><td>{}</td>", escaped(row.today),
                                    escaped(row.limit), escaped(row.peer))
                      : fmt::format("<td class=\"text why\" colspan=\"3\">{}</td>", escaped(row.why));
  return fmt::format("<tr class=\"{}\"><td>{}</td>{}<td class=\"standing short\">{}</td></tr>\n", css_class,
                     escaped(row.what), today, standing);
}

std::string section_html(const EvidenceSection& section) {
  std::string html =
      fmt::format("<h2 id=\"{}\">{}</h2>\n<p class=\"command\"><code>{}</code>{}</p>\n",
                  escaped(section.part.name), escaped(section.part.title), escaped(section.command),
                  section.wall_s > 0.0 ? fmt::format(" &ndash; {:.1f} s", section.wall_s) : "");
  html +=
      "<table><tr><th>promise</th><th>today</th><th>limit</th><th>peer, same run</th><th>stands</th></tr>\n";
  for (const EvidenceRow& row : section.rows) html += body_row(row);
  return html + fmt::format("</table>\n<ul><li>May be concluded: {}</li><li>May not: {}</li></ul>\n",
                            escaped(section.part.conclude), escaped(section.part.not_conclude));
}

long count_of(const Evidence& evidence, EvidenceStanding standing) {
  long count = 0;
  for (const EvidenceSection& section : evidence.sections)
    count += std::ranges::count(section.rows, standing, &EvidenceRow::standing);
  return count;
}

std::string counts_of(const Evidence& evidence) {
  std::string counts;
  for (const EvidenceStanding standing : all_standings)
    if (const long count = count_of(evidence, standing); count > 0)
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, to_string(standing));
  return counts;
}

std::string machine_html(const Evidence& evidence) {
  const Machine& machine = evidence.machine;
  std::string html = "<table>";
  const auto line = [&html](const char* name, const std::string& value) {
    html += fmt::format("<tr><td>{}</td><td class=\"text\">{}</td></tr>\n", name, escaped(value));
  };
  line("date", evidence.date);
  line("version, commit", fmt::format("{}, {}", evidence.version, evidence.build.commit));
  line("compiler",
       evidence.build.compiler + (evidence.build.is_optimized ? "" : ", NOT OPTIMIZED: no times count"));
  line("processor", fmt::format("{}; {} cores usable", machine.processor, machine.cores));
  line("memory", fmt::format("{:.1f} GB", machine.memory_gb));
  line("system", machine.system);
  line("load at the begin",
       fmt::format("{:.2f}{}", machine.load,
                   machine.load > 0.5 ? ": others computed too, times are too long" : ""));
  return html + "</table>\n";
}

std::string elsewhere_html() {
  std::string html =
      "<h2 id=\"elsewhere\">Not measured by this command</h2>\n<table><tr><th>what</th><th>by</th></tr>\n";
  for (const Elsewhere& each : measured_elsewhere)
    html += fmt::format("<tr><td>{}</td><td class=\"text\"><code>{}</code></td></tr>\n", escaped(each.what),
                        escaped(each.command));
  return html + "</table>\n";
}

constexpr const char* how_to_read = R"(<h2 id="reading">How to read this</h2>
<ul><li>Each figure comes from the command above its table, run for this page; what the command printed is beside the page,
in <code>raw/</code>. Whoever runs it with the same commit gets the same counts and errors; times are of this machine.</li>
<li>A peer was run on the same input in the same process, so their ratio says more than either time.</li>
<li>All of it is simulated: rendered frames, a simulated base, people that are discs. It shows what the program does with
the light, noise and faults that were thought of, not what a ceiling, a lens or a crowd will do.</li>
<li>No part of Lodestar is certified. A count of zero in N trials means a rate below 3/N with 95 % confidence, in trials of
this kind.</li></ul>
)";

}  // namespace

std::string evidence_html(const Evidence& evidence) {
  std::string body = style_of_standings;
  body += fmt::format("<h1>Lodestar {}: evidence</h1>\n<p class=\"lead\">{}</p>\n", escaped(evidence.version),
                      escaped(counts_of(evidence)));
  if (evidence.quick)
    body +=
        "<p><b>Quick run.</b> Few trials: it shows that the commands work. Judged is only what a single case "
        "breaks, such as a contact.</p>\n";
  body += machine_html(evidence);
  body += how_to_read;
  for (const EvidenceSection& section : evidence.sections) body += section_html(section);
  body += elsewhere_html();
  return page_html("Lodestar: evidence", body);
}

std::string evidence_text(const Evidence& evidence) {
  std::string text;
  for (const EvidenceSection& section : evidence.sections) {
    for (const EvidenceRow& row : section.rows) {
      if (row.standing == EvidenceStanding::kept || row.standing == EvidenceStanding::measured ||
          row.standing == EvidenceStanding::not_judged || row.standing == EvidenceStanding::left_out)
        continue;
      text += fmt::format("{}: {}: {}\n", to_string(row.standing), row.what,
                          row.why.empty() ? fmt::format("{}, {}", row.today, row.limit) : row.why);
    }
  }
  return text + counts_of(evidence) + "\n";
}

}  // namespace lodestar
