#pragma once
// What is made from the declared commands and the table of keys, so that it cannot differ from them: the man page and
// the completions of bash and zsh.
#include <CLI/CLI.hpp>
#include <string>

namespace cli {

std::string man_page(const CLI::App& program);
std::string bash_completion(const CLI::App& program);
std::string zsh_completion(const CLI::App& program);

}  // namespace cli
