// demcal help, and what is made from the same tables: the man page and the completions.
#include <catch2/catch.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;

namespace {

/// The commands, from the program's own help.
std::vector<std::string> commands(const Folder& folder) {
  std::istringstream lines(folder.demcal({"--help"}).out);
  std::vector<std::string> names;
  bool there = false;
  for (std::string line; std::getline(lines, line);) {
    if (there && line.size() > 2 && line[0] == ' ' && line[2] != ' ')
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    there = there || line == "Subcommands:";
  }
  return names;
}

/// The long options of a command, from its help.
std::vector<std::string> options(const Folder& folder, const std::string& command) {
  std::istringstream words(folder.demcal({command, "--help"}).out);
  std::vector<std::string> names;
  for (std::string line; std::getline(words, line);)
    if (const auto at = line.find("--"); line.starts_with("  ") && at != std::string::npos && at < 6)
      names.push_back(line.substr(at, line.find_first_of(" ,", at) - at));
  return names;
}

}  // namespace

TEST_CASE("every command has an example in its help, and demcal help shows that help") {
  const Folder folder;
  const auto names = commands(folder);
  CHECK(names.size() >= 11);
  for (const std::string& name : names) {
    const auto outcome = folder.demcal({name, "--help"});
    CHECK_THAT(outcome.out, Contains("Example: demcal " + name));
    CHECK(options(folder, name).size() >= 1);
    CHECK_THAT(folder.demcal({"help", name}).out, Contains("Example: demcal " + name));
  }
}

TEST_CASE("help on a key says type, unit, range, default and an example, also for the user's own names") {
  const Folder folder;
  const auto help = [&](const std::string& topic) { return folder.demcal({"help", topic}).out; };
  CHECK_THAT(help("training.standard_error"),
             Contains("number, above 0 to 1") && Contains("default: 0.") && Contains("example: standard_error = 0.03"));
  CHECK_THAT(help("contact.stiffness"), Contains("a unit of N/m") && Contains("from 0.001 to 1e+09"));
  CHECK_THAT(help("materials.sand.density"), Contains("materials.NAME.density") && Contains("kg/m3"));
  CHECK_THAT(help("contact.normal"), Contains("one of linear, hertz, jkr"));
  CHECK_THAT(help("[[observe]]"), Contains("observe.file") && Contains("observe.common_error"));
  CHECK_THAT(help("geometric_sd"), Contains("materials.NAME.distribution.geometric_sd"));
  CHECK_THAT(folder.demcal({"help"}).out, Contains("calibrate") && Contains("training, surrogate, observe"));
}

TEST_CASE("help on what does not exist names what was meant") {
  const Folder folder;
  CHECK_THAT(folder.says({"help", "contact.frictoin"}, 64), Contains("did you mean 'contact.friction'?"));
  CHECK_THAT(folder.demcal({"help", "calibrat"}).err, Contains("did you mean 'calibrate'?"));
}

TEST_CASE("man page and completions hold every command and option, and bash takes its own") {
  const Folder folder;
  const std::string man = folder.demcal({"help", "--as", "man"}).out,
                    bash = folder.demcal({"help", "--as", "bash"}).out,
                    zsh = folder.demcal({"help", "--as", "zsh"}).out;
  folder.write("demcal.bash", bash);
  for (const std::string& command : commands(folder)) {
    CHECK_THAT(man, Contains(".SS demcal " + command));
    CHECK_THAT(zsh, Contains("'" + command + ":"));
    const std::string offered = folder
                                    .shell("bash -c '. ./demcal.bash; COMP_WORDS=(demcal " + command +
                                           " --); COMP_CWORD=2; _demcal; echo \"${COMPREPLY[@]}\"'")
                                    .out;
    for (const std::string& option : options(folder, command)) {
      INFO(command << " " << option);
      if (command != "help") CHECK_THAT(offered, Contains(option));
      CHECK_THAT(zsh, Contains("'" + option + "["));
      if (option == "--help") continue;
      std::string escaped;
      for (const char c : option) escaped += c == '-' ? std::string("\\-") : std::string(1, c);
      CHECK_THAT(man, Contains(".B " + escaped));
    }
  }
  const auto first =
      folder.shell("bash -c '. ./demcal.bash; COMP_WORDS=(demcal cal); COMP_CWORD=1; _demcal; echo ${COMPREPLY[@]}'");
  CHECK(first.out == "calibrate\n");
  CHECK_THAT(man, Contains(".B contact.friction") && Contains("EXIT STATUS") && Contains("NO_COLOR"));
}
