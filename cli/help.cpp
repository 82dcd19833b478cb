// demcal help: a command, or a key of the study file. With --as it gives the texts that are installed: the man page and
// completions.
#include <fmt/format.h>

#include "cli/command.hpp"
#include "cli/reference.hpp"
#include "data/edit_distance.hpp"
#include "data/study_keys.hpp"
#include "data/terminal.hpp"

namespace cli {
namespace {

std::string overview(const CLI::App& program) {
  return program.help() + fmt::format(
                              "\nKeys of study.toml, by section: {}\n"
                              "  demcal help SECTION     its keys\n"
                              "  demcal help KEY         one of them: type, unit, range, default, example\n",
                              fmt::join(data::study_sections(), ", "));
}

std::string keys_text(const std::vector<data::StudyKey>& keys) {
  std::string text;
  if (keys.size() <= 3) {
    for (const data::StudyKey& key : keys) text += (text.empty() ? "" : "\n\n") + data::describe(key);
    return text;
  }
  for (const data::StudyKey& key : keys) text += fmt::format("{:<38} {}\n", key.name, key.meaning);
  return text + "One of them: demcal help KEY";
}

/// A whole file, whose last line ends once.
void give(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  data::print_result(text);
}

data::ExitStatus help_on(const CLI::App& program, const std::string& topic) {
  std::vector<std::string> commands;
  for (const CLI::App* command : program.get_subcommands({})) {
    commands.push_back(command->get_name());
    if (command->get_name() != topic) continue;
    data::print_answer(command->help());
    return data::ExitStatus::done;
  }
  const std::vector<data::StudyKey> keys = data::find_study_keys(topic);
  if (keys.empty()) {
    auto near = data::nearest(topic, commands);
    if (!near) near = data::nearest_study_key(topic);
    throw data::InputError(data::ExitStatus::usage,
                           {topic, "is neither a command nor a key of study.toml",
                            near ? fmt::format("did you mean '{}'?", *near) : "demcal help lists them"});
  }
  data::print_answer(keys_text(keys));
  return data::ExitStatus::done;
}

}  // namespace

Action add_help(CLI::App& program) {
  const auto topic = std::make_shared<std::string>();
  const auto as = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("help", "explain a command, or a key of study.toml");
  command->add_option("TOPIC", *topic, "a command, a key (contact.friction) or a section (contact)");
  command->add_option("--as", *as, "everything, as a man page, as docs/keys.md, or as a completion of bash or zsh")
      ->check(one_of({"man", "keys", "bash", "zsh"}));
  command->footer("Example: demcal help training.standard_error");
  return [&program, topic, as] {
    if (*as == "man") give(man_page(program));
    if (*as == "keys") give(data::study_keys_page());
    if (*as == "bash") give(bash_completion(program));
    if (*as == "zsh") give(zsh_completion(program));
    if (!as->empty()) return data::ExitStatus::done;
    if (!topic->empty()) return help_on(program, *topic);
    data::print_answer(overview(program));
    return data::ExitStatus::done;
  };
}

}  // namespace cli
