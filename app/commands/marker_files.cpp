#include <algorithm>
#include <fmt/core.h>
#include <iterator>
#include <memory>

#include "app/commands/commands.hpp"
#include "app/placement/formats.hpp"
#include "app/placement/place_sheet.hpp"
#include "app/site/site_folder.hpp"
#include "maps/atomic_file.hpp"
#include "maps/file_text.hpp"
#include "maps/input_error.hpp"
#include "maps/marker.hpp"

// The subcommands of `lodestar markers` that write files for other programs and people: convert and print.
namespace lodestar {
namespace {

namespace fs = std::filesystem;

struct ConvertArguments {
  std::string input;
  std::string output;
  std::string from;
  std::string to;
};

struct PrintArguments {
  std::vector<int> ids;
  std::string output;
  std::string site;
  std::string date;
  std::string paper = "A4";
};

MarkerFormat format_of(const char* option, const std::string& name, const fs::path& file,
                       const std::string& text) {
  const std::optional<MarkerFormat> format =
      name.empty() ? guess_marker_format(file, text) : marker_format_named(name);
  if (!format) {
    throw InputError(file, 0, "a name that does not tell the format", std::string(option) + " FORMAT");
  }
  return *format;
}

ExitCode convert(const ConvertArguments& arguments) {
  const std::string text = file_text(arguments.input, "markers");
  const MarkerFormat from = format_of("--from", arguments.from, arguments.input, text);
  const MarkerFormat to = arguments.output.empty() && arguments.to.empty()
                              ? MarkerFormat::lodestar
                              : format_of("--to", arguments.to, arguments.output, "");
  const MarkerRegistry registry = parse_markers(text, from, arguments.input);
  const std::string converted = markers_text(registry, to);
  if (arguments.output.empty()) {
    fmt::print("{}", converted);
  } else {
    write_file_atomically(arguments.output, converted);
    fmt::print(stderr, "{} markers in {}\n", registry.markers.size(), arguments.output);
  }
  return done;
}

std::vector<SheetPage> sheets_of(const PrintArguments& arguments) {
  const PaperSize paper = *paper_named(arguments.paper);
  std::vector<SheetPage> pages;
  if (arguments.site.empty()) {
    if (arguments.ids.empty())
      throw InputError("markers print: found neither IDs nor a site, wanted one of them");
    for (const int id : arguments.ids) pages.push_back(draw_marker_sheet(id, paper));
    return pages;
  }
  const Site site = open_site(arguments.site);
  const PlaceSheets places(site.map.map, site.name, arguments.date, paper);
  std::vector<int> ids = arguments.ids;
  if (ids.empty())
    std::ranges::transform(site.registry.markers, std::back_inserter(ids), &RegisteredMarker::id);
  if (ids.empty()) throw InputError(site.registry_file, 0, "no marker", "some to print");
  for (const int id : ids) {
    const RegisteredMarker* const marker = site.registry.find(id);
    if (marker == nullptr)
      throw InputError(site.registry_file, 0, fmt::format("no marker {}", id), "those to print");
    pages.push_back(places.page(site.registry, *marker));
  }
  return pages;
}

ExitCode print_sheets(const PrintArguments& arguments) {
  const fs::path output = arguments.output;
  const bool pdf = output.extension() == ".pdf";
  if (!pdf && output.extension() != ".svg") {
    throw InputError("-o: found '" + arguments.output + "', wanted a name that ends in .pdf or .svg");
  }
  const std::vector<SheetPage> pages = sheets_of(arguments);
  write_file_atomically(output, pdf ? pdf_text(pages) : svg_text(pages));
  fmt::print(stderr, "{} sheets in {}: print at 100 % and measure the ruler\n", pages.size(),
             arguments.output);
  return done;
}

}  // namespace

std::vector<Command> marker_file_commands(CLI::App& markers) {
  const auto converted = std::make_shared<ConvertArguments>();
  CLI::App* convert_command = markers.add_subcommand(
      "convert",
      "Convert markers between our registry and other programs' formats; poses are in the map frame");
  convert_command->add_option("input", converted->input, "Marker file to read")->required();
  convert_command->add_option("-o,--output", converted->output, "File to write; default: standard output");
  for (const auto& [name, format] : {std::pair{"--from", &converted->from}, {"--to", &converted->to}}) {
    convert_command->add_option(name, *format, "The format, where the file name does not imply it")
        ->check(CLI::IsMember(marker_format_names()));
  }

  const auto printed = std::make_shared<PrintArguments>();
  CLI::App* print_command =
      markers.add_subcommand("print", "Sheets in true scale: dots, cut marks, ruler, arrow, drill crosses");
  print_command
      ->add_option("ids", printed->ids,
                   "IDs, each on a sheet of its own; with --site: all of it when left out")
      ->check(CLI::Range(0, marker_id_count - 1));
  print_command->add_option("-o,--output", printed->output, "sheet.pdf or sheet.svg")->required();
  CLI::Option* const site = print_command->add_option(
      "--site", printed->site, "Site folder: each sheet says where its marker hangs, with a plan");
  print_command->add_option("--date", printed->date, "With --site: the date to print")->needs(site);
  print_command->add_option("--paper", printed->paper, "A4 or A3")
      ->check(CLI::IsMember({"A4", "A3"}))
      ->capture_default_str();

  return {{convert_command, [converted] { return convert(*converted); }},
          {print_command, [printed] { return print_sheets(*printed); }}};
}

}  // namespace lodestar
