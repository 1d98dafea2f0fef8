#include "app/commands/command_pages.hpp"

#include <gmock/gmock.h>

namespace lodestar {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// `prog map slice [--height FLOAT] [--format csv|json] FILE`, and a command that the help hides.
class CommandPages : public testing::Test {
 protected:
  CommandPages() {
    CLI::App* const map = app_.add_subcommand("map", "Maps");
    CLI::App* const slice = map->add_subcommand("slice", "Cut a slab; exit 1 when it's empty");
    slice->add_option("file", file_, "Map\\file")->required()->check(CLI::ExistingFile);
    slice->add_option("-z,--height", height_, "Height in metres")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 3.0));
    slice->add_option("--format", format_, ".csv or json")
        ->check(CLI::IsMember({"csv", "json"}))
        ->envname("FORMAT");
    app_.add_subcommand("hidden", "For the build")->group("");
  }

  [[nodiscard]] CommandPage tree() const { return command_tree(app_); }
  [[nodiscard]] CommandPage slice() const { return tree().subcommands.at(0).subcommands.at(0); }

  double height_ = 0.5;
  std::string file_;
  std::string format_;
  CLI::App app_{"A program", "prog"};
};

TEST_F(CommandPages, are_those_of_all_commands_that_the_help_shows) {
  const CommandPage program = tree();
  std::vector<std::string> names;
  for (const CommandPage* const page : all_pages(program)) names.push_back(manual_name(*page));
  EXPECT_THAT(names, ElementsAre("prog", "prog-map", "prog-map-slice"));
}

TEST_F(CommandPages, know_what_options_take) {
  const CommandPage page = slice();
  const auto option = [&page](std::string_view name) {
    return *std::ranges::find_if(page.options, [name](const OptionPage& each) {
      return each.positional == name || std::ranges::find(each.names, name) != each.names.end();
    });
  };
  EXPECT_TRUE(option("file").is_required);
  EXPECT_EQ(option("file").value, "FILE");
  EXPECT_THAT(option("--height").names, ElementsAre("-z", "--height"));
  EXPECT_EQ(option("--height").value, "FLOAT in [0 - 3]");
  EXPECT_EQ(option("--height").initial, "0.5");
  EXPECT_THAT(option("--format").choices, ElementsAre("csv", "json"));
  EXPECT_EQ(option("--help").value, "");
}

TEST_F(CommandPages, become_pages_of_the_manual) {
  const std::string page = manual_page(slice(), "1.2.3");
  EXPECT_THAT(page, StartsWith(".TH PROG\\-MAP\\-SLICE 1 \"\" \"lodestar 1.2.3\""));
  EXPECT_THAT(page, HasSubstr("prog\\-map\\-slice \\- Cut a slab\n"));
  EXPECT_THAT(page,
              HasSubstr("\\fB\\-z\\fR, \\fB\\-\\-height\\fR \\fIFLOAT in [0 \\- 3]\\fR\nHeight in metres\n"));
  EXPECT_THAT(page, AllOf(HasSubstr("One of: csv, json."), HasSubstr("Default: 0.5."),
                          HasSubstr("The environment's FORMAT")));
  // What troff would take for a command or an escape.
  EXPECT_THAT(page, AllOf(HasSubstr("\n\\&.csv or json\n"), HasSubstr("\nMap\\efile\n")));
  EXPECT_THAT(manual_page(tree(), "1.2.3"), AllOf(HasSubstr(".BR prog\\-map (1)"), Not(HasSubstr("hidden"))));
}

TEST_F(CommandPages, become_completions) {
  for (const std::string& script : {bash_completion(tree()), zsh_completion(tree())}) {
    EXPECT_THAT(script, HasSubstr("' map' | ' map slice')"));
    EXPECT_THAT(script, HasSubstr("' map slice --format')"));
    EXPECT_THAT(script, HasSubstr("csv json"));
    EXPECT_THAT(script, Not(HasSubstr("hidden")));
  }
  EXPECT_THAT(zsh_completion(tree()), HasSubstr("'slice:Cut a slab; exit 1 when it'\\''s empty'"));
}

}  // namespace
}  // namespace lodestar
