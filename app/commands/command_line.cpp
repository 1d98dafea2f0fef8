#include <filesystem>
#include <memory>

#include "app/commands/command_pages.hpp"
#include "app/commands/commands.hpp"
#include "maps/atomic_file.hpp"

namespace lodestar {
namespace {

/// The files of a package that follow from the command line, in a folder laid out like share/ of a prefix.
ExitCode write_command_line(const CLI::App& lodestar, const std::filesystem::path& share) {
  const CommandPage program = command_tree(lodestar);
  const auto write = [&share](const std::filesystem::path& name, const std::string& text) {
    std::filesystem::create_directories((share / name).parent_path());
    write_file_atomically(share / name, text);
  };
  for (const CommandPage* const page : all_pages(program))
    write("man/man1/" + manual_name(*page) + ".1", manual_page(*page, LODESTAR_VERSION));
  write("bash-completion/completions/lodestar", bash_completion(program));
  write("zsh/vendor-completions/_lodestar", zsh_completion(program));
  return done;
}

}  // namespace

/// Hidden from the help: the build runs it once.
std::vector<Command> command_line_commands(CLI::App& lodestar) {
  const auto share = std::make_shared<std::string>();
  CLI::App* command = lodestar.add_subcommand("command-line", "Write manual pages and completions");
  command->group("");
  command->add_option("share", *share, "Folder to write them into")->required();
  return {{command, [&lodestar, share] { return write_command_line(lodestar, *share); }}};
}

}  // namespace lodestar
