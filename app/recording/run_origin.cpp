#include "app/recording/run_origin.hpp"

#include <fmt/format.h>

#include "maps/atomic_file.hpp"
#include "maps/input_error.hpp"
#include "maps/map_file.hpp"
#include "maps/path_kind.hpp"
#include "maps/strict_yaml.hpp"
#include "maps/yaml_quoting.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

constexpr const char* file_name = "run.yaml";

std::uint64_t seed_in(StrictYaml& yaml) {
  const std::string text = yaml.text("seed");
  const bool is_number =
      !text.empty() && text.size() <= 20 && text.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number) yaml.refuse("seed", "'" + text.substr(0, 40) + "'", "a whole number");
  return std::strtoull(text.c_str(), nullptr, 10);
}

}  // namespace

void write_run_origin(const fs::path& folder, const RunOrigin& origin, const OccupancyMap& map,
                      const MarkerRegistry& registry) {
  std::error_code error;
  fs::create_directories((folder / map_of_run).parent_path(), error);
  if (error)
    throw InputError(folder, 0, "a folder that could not be made (" + error.message() + ")", "one that can");
  save_map(map, folder / map_of_run);
  save_registry(registry, folder / markers_of_run);
  std::string text = fmt::format("format: lodestar-run\nversion: 1\nstarted: {}\nprogram: {}\nsite: {}\n",
                                 origin.started, yaml_quoted(origin.program), yaml_quoted(origin.site));
  if (origin.seed) text += fmt::format("seed: {}\n", *origin.seed);
  if (origin.clock_offset) text += fmt::format("clock_offset_s: {:.6f}\n", seconds(*origin.clock_offset));
  write_file_atomically(folder / file_name, text);
}

std::optional<RunOrigin> read_run_origin(const fs::path& folder) {
  if (!is_file(folder / file_name)) return std::nullopt;
  StrictYaml yaml = StrictYaml::load(folder / file_name);
  if (const std::string format = yaml.text("format"); format != "lodestar-run")
    yaml.refuse("format", "'" + format.substr(0, 40) + "'", "lodestar-run");
  (void)yaml.integer("version", 1, 1);
  RunOrigin origin{.started = yaml.text("started"),
                   .program = yaml.text("program"),
                   .site = yaml.text("site"),
                   .seed = std::nullopt};
  if (yaml.has("seed")) origin.seed = seed_in(yaml);
  if (yaml.has("clock_offset_s")) origin.clock_offset = from_seconds(yaml.number("clock_offset_s"));
  yaml.finish();
  return origin;
}

}  // namespace lodestar
