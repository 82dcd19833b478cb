#pragma once
// What a command line that is not understood may have meant.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace cli {

/// A message about the first word that is no command, or no option of its command, with the one that is nearest;
/// nothing when it is not such a word that is wrong. `words`: the command line without the program's name.
std::string misspelt(const CLI::App& program, const std::vector<std::string>& words);

}  // namespace cli
