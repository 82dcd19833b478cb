#include "cli/misspelt.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/edit_distance.hpp"
#include "data/error.hpp"

namespace cli {
namespace {

std::string say(const std::string& word, const std::string& what, const std::vector<std::string>& known,
                const std::string& otherwise) {
  const auto near = data::nearest(word, known);
  return data::describe({{word, what, near ? fmt::format("did you mean '{}'?", *near) : otherwise}});
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

}  // namespace

std::string misspelt(const CLI::App& program, const std::vector<std::string>& words) {
  if (words.empty()) return {};
  const CLI::App* command = nullptr;
  std::vector<std::string> commands;
  for (const CLI::App* one : program.get_subcommands({})) {
    commands.push_back(one->get_name());
    if (one->get_name() == words.front()) command = one;
  }
  if (command == nullptr) {
    if (words.front().starts_with("-"))
      return say(words.front(), "is not an option of demcal", options_of(program), "demcal --help lists them");
    return say(words.front(), "is not a command of demcal", commands, "demcal --help lists them");
  }
  const std::vector<std::string> known = options_of(*command);
  const std::string name = command->get_name();
  for (std::size_t i = 1; i < words.size() && words[i] != "--"; ++i) {
    const std::string option = words[i].substr(0, words[i].find('='));
    if (!option.starts_with("--") || std::find(known.begin(), known.end(), option) != known.end()) continue;
    return say(option, "is not an option of demcal " + name, known, fmt::format("demcal {} --help lists them", name));
  }
  return {};
}

}  // namespace cli
