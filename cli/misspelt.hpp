#pragma once
// The command or option that a misspelt command line may have meant.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace cli {

/// A message about the first word that is no command, or no option of its command, with the nearest one; nothing when
/// no such word is wrong. `words`: the command line without the program's name.
std::string misspelt(const CLI::App& program, const std::vector<std::string>& words);

}  // namespace cli
