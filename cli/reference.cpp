#include "cli/reference.hpp"

#include <fmt/format.h>

#include "data/provenance.hpp"
#include "data/study_keys.hpp"

namespace cli {
namespace {

/// Text of a man page: a leading dot or quote would be a request, and a hyphen could become another character.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  if (!out.empty() && (out.front() == '.' || out.front() == '\'')) out = "\\&" + out;
  return out;
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

std::vector<const CLI::Option*> long_options(const CLI::App& command) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* option : command.get_options())
    if (!option->get_lnames().empty() && !option->get_group().empty()) options.push_back(option);  // "": hidden
  return options;
}

std::string positionals(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      text += option->get_required() ? " " + option->get_name() : " [" + option->get_name() + "]";
  return text;
}

std::string name_of(const CLI::Option& option) { return "--" + option.get_lnames().front(); }

std::string options_text(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : long_options(command)) {
    if (!text.empty()) text += ' ';
    text += name_of(*option);
  }
  return text;
}

std::string man_command(const CLI::App& command) {
  std::string text = fmt::format(".SS demcal {}{} [OPTIONS]\n{}.\n", roff(command.get_name()),
                                 roff(positionals(command)), roff(command.get_description()));
  for (const CLI::Option* option : long_options(command)) {
    if (name_of(*option) == "--help") continue;
    text += fmt::format(".TP\n.B {}{}\n{}\n", roff(name_of(*option)),
                        is_flag(*option) ? "" : " " + roff(option->get_type_name()), roff(option->get_description()));
  }
  return text + fmt::format(".PP\n{}\n", roff(command.get_footer()));
}

/// The text in a shell's single quotes.
std::string in_single_quotes(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// A text inside the brackets of a zsh specification.
std::string zsh_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string topics(const CLI::App& program) {
  std::string words;
  for (const CLI::App* command : program.get_subcommands({})) words += command->get_name() + " ";
  for (const std::string& section : data::study_sections()) words += section + " ";
  for (const data::StudyKey& key : data::study_keys()) words += std::string(key.name) + " ";
  words.pop_back();
  return words;
}

}  // namespace

std::string man_page(const CLI::App& program) {
  std::string page = fmt::format(
      ".TH DEMCAL 1 \"\" \"demcal {0}\" \"User Commands\"\n.SH NAME\ndemcal \\- calibrates a discrete element model of "
      "a powder against measured torque\n.SH SYNOPSIS\n.B demcal\n.I COMMAND\n[ARGUMENTS]\n.SH DESCRIPTION\n{1}\n",
      roff(data::program_version()), roff(program.get_description()));
  page += ".SH COMMANDS\n";
  for (const CLI::App* command : program.get_subcommands({})) page += man_command(*command);
  page += ".SH EXIT STATUS\n";
  for (const auto& [status, meaning] : {std::pair{"0", "done, also when the answer is \"not identified\""},
                                        {"2", "done, and a line that begins with \"warning\" says what is doubtful"},
                                        {"64", "wrong usage"},
                                        {"65", "bad data"},
                                        {"66", "missing input"},
                                        {"69", "a program that is needed is missing"},
                                        {"70", "a defect of demcal"},
                                        {"73", "cannot write"},
                                        {"75", "interrupted; the same command goes on"},
                                        {"78", "bad study"}})
    page += fmt::format(".TP\n.B {}\n{}\n", status, roff(meaning));
  page += ".SH ENVIRONMENT\n.TP\n.B NO_COLOR\nwhen set and not empty, nothing is coloured on a terminal\n";
  page += ".SH KEYS OF STUDY.TOML\nNAME stands for a name of the user's choosing.\n";
  for (const data::StudyKey& key : data::study_keys()) {
    const std::string all = data::describe(key);
    const std::size_t first = all.find('\n') + 1;
    std::string rest;
    for (std::size_t at = first; at < all.size();) {
      const std::size_t end = std::min(all.find('\n', at), all.size());
      rest += (rest.empty() ? "" : "\n.br\n") + roff(std::string_view(all).substr(at + 2, end - at - 2));
      at = end + 1;
    }
    page += fmt::format(".TP\n.B {}\n{}\n", roff(key.name), rest);
  }
  return page;
}

std::string bash_completion(const CLI::App& program) {
  std::string commands, cases;
  for (const CLI::App* command : program.get_subcommands({})) {
    commands += (commands.empty() ? "" : " ") + command->get_name();
    cases += fmt::format("    {}) options={} ;;\n", command->get_name(), in_single_quotes(options_text(*command)));
  }
  return fmt::format(
      "# Completion of demcal for bash.\n"
      "_demcal() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} options=\n"
      "  if [ \"$COMP_CWORD\" = 1 ]; then\n"
      "    COMPREPLY=($(compgen -W {} -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  if [ \"${{COMP_WORDS[1]}}\" = help ]; then\n"
      "    COMPREPLY=($(compgen -W {} -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  case ${{COMP_WORDS[1]}} in\n{}  esac\n"
      "  case $word in\n"
      "    -*) COMPREPLY=($(compgen -W \"$options\" -- \"$word\")) ;;\n"
      "    *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n"
      "  esac\n"
      "}}\n"
      "complete -o filenames -F _demcal demcal\n",
      in_single_quotes(commands + " --help --version"), in_single_quotes(topics(program)), cases);
}

std::string zsh_completion(const CLI::App& program) {
  std::string commands, cases;
  for (const CLI::App* command : program.get_subcommands({})) {
    commands += "    " + in_single_quotes(command->get_name() + ":" + zsh_text(command->get_description())) + "\n";
    cases += fmt::format("      {}) _arguments", command->get_name());
    for (const CLI::Option* option : long_options(*command))
      cases += " " + in_single_quotes(
                         fmt::format("{}[{}]{}", name_of(*option), zsh_text(option->get_description()),
                                     is_flag(*option) ? "" : ":" + zsh_text(option->get_type_name()) + ":_files"));
    cases += command->get_name() == "help" ? " '*:topic:(" + topics(program) + ")'" : " '*:file:_files'";
    cases += " ;;\n";
  }
  return fmt::format(
      "#compdef demcal\n"
      "# Completion of demcal for zsh.\n"
      "_demcal() {{\n"
      "  local -a commands\n"
      "  commands=(\n{}  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe command commands\n"
      "  else\n"
      "    shift words\n"
      "    (( CURRENT-- ))\n"
      "    case $words[1] in\n{}    esac\n"
      "  fi\n"
      "}}\n"
      "_demcal \"$@\"\n",
      commands, cases);
}

}  // namespace cli
