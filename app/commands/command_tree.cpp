#include "app/commands/command_tree.hpp"

#include <algorithm>
#include <string_view>

namespace lodestar {
namespace {

struct ValueKind {
  std::string value;
  std::vector<std::string> choices;
};

/// From CLI11's name of a type: the type, then what each check wants after a colon. "TEXT:FILE",
/// "INT:INT in [1 - 9]", "TEXT:{csv,json}". The last says most; checks without a name leave nothing.
ValueKind value_kind(std::string_view type_name) {
  while (type_name.ends_with(':')) type_name.remove_suffix(1);
  const std::size_t brace = type_name.find(":{");
  if (brace == std::string_view::npos) {
    const std::size_t colon = type_name.rfind(':');
    return {std::string(colon == std::string_view::npos ? type_name : type_name.substr(colon + 1)), {}};
  }
  ValueKind kind{std::string(type_name.substr(0, brace)), {}};
  std::string_view rest = type_name.substr(brace + 2);
  rest = rest.substr(0, rest.find('}'));
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    kind.choices.emplace_back(rest.substr(0, comma));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return kind;
}

OptionPage page_of(const CLI::Option& option) {
  OptionPage page;
  for (const std::string& name : option.get_snames()) page.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) page.names.push_back("--" + name);
  if (page.names.empty()) page.positional = option.get_name();
  const bool takes_value = option.get_items_expected_max() > 0;
  if (takes_value) {
    ValueKind kind = value_kind(option.get_type_name());
    page.value = std::move(kind.value);
    page.choices = std::move(kind.choices);
    page.initial = option.get_default_str();
  }
  page.description = option.get_description();
  page.environment = option.get_envname();
  page.is_required = option.get_required();
  page.may_repeat = option.get_items_expected_max() > 1 ||
                    (takes_value && option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll);
  return page;
}

CommandPage page_of(const CLI::App& command, std::vector<std::string> words) {
  words.push_back(command.get_name());
  CommandPage page{.words = words, .description = command.get_description()};
  for (const CLI::Option* const option : command.get_options())
    if (!option->get_group().empty()) page.options.push_back(page_of(*option));
  for (const CLI::App* const inner : command.get_subcommands([](const CLI::App*) { return true; }))
    if (!inner->get_group().empty()) page.subcommands.push_back(page_of(*inner, words));
  return page;
}

void append_pages(const CommandPage& page, std::vector<const CommandPage*>& all) {
  all.push_back(&page);
  for (const CommandPage& inner : page.subcommands) append_pages(inner, all);
}

}  // namespace

CommandPage command_tree(const CLI::App& app) {
  return page_of(app, {});
}

std::vector<const CommandPage*> all_pages(const CommandPage& page) {
  std::vector<const CommandPage*> all;
  append_pages(page, all);
  return all;
}

}  // namespace lodestar
