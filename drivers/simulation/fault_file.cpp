#include "drivers/simulation/fault_file.hpp"

#include <algorithm>

#include "drivers/simulation/fault_table.hpp"
#include "maps/strict_yaml.hpp"

namespace lodestar {
namespace {

constexpr double longest_s = 1e5;
constexpr int highest_id = 4095;

std::string all_names() {
  std::string names;
  for (const FaultRow& row : fault_table()) names.append(names.empty() ? "one of " : ", ").append(row.name);
  return names;
}

const FaultRow& row_of(StrictYaml& yaml) {
  const std::string name = yaml.text("fault");
  const auto rows = fault_table();
  const auto row = std::ranges::find(rows, name, &FaultRow::name);
  if (row == rows.end()) yaml.refuse("fault", "'" + name + "'", all_names());
  return *row;
}

void read_times(StrictYaml& yaml, const FaultRow& row, Fault& fault) {
  if (yaml.has("between_s")) {
    const std::vector<double> between_s = yaml.numbers("between_s", 2);
    if (between_s[0] < 0.0 || between_s[1] < between_s[0] || between_s[1] > longest_s)
      yaml.refuse("between_s", "no interval", "[earliest, latest] in seconds from 0 on");
    fault.begin = from_seconds(between_s[0]);
    fault.latest_begin = from_seconds(between_s[1]);
  } else {
    fault.begin = from_seconds(yaml.number("at_s", 0.0, longest_s));
  }
  if (!row.is_instantaneous && yaml.has("for_s"))
    fault.lasts = from_seconds(yaml.number("for_s", 0.0, longest_s));
}

Fault read_fault(StrictYaml& yaml) {
  const FaultRow& row = row_of(yaml);
  Fault fault{.kind = row.kind};
  read_times(yaml, row, fault);
  if (row.concerns_a_marker && yaml.has("marker")) fault.marker = yaml.integer("marker", 0, highest_id);
  for (const FaultParameter& parameter : row.parameters) {
    fault.*parameter.value =
        parameter.unit_factor * yaml.number(std::string(parameter.key), parameter.low, parameter.high);
  }
  yaml.finish();
  return fault;
}

}  // namespace

std::vector<Fault> load_faults(const std::filesystem::path& file) {
  StrictYaml yaml = StrictYaml::load(file);
  const std::string format = yaml.text("format");
  if (format != "lodestar-faults") yaml.refuse("format", "'" + format + "'", "'lodestar-faults'");
  (void)yaml.integer("version", 1, 1);
  std::vector<Fault> faults;
  for (StrictYaml& entry : yaml.list_of_mappings("faults")) faults.push_back(read_fault(entry));
  yaml.finish();
  return faults;
}

}  // namespace lodestar
