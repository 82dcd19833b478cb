#pragma once
// The man page and the completions of bash and zsh. They are made from the declared commands and the table of keys, so
// that they cannot differ from these.
#include <CLI/CLI.hpp>
#include <string>

namespace cli {

std::string man_page(const CLI::App& program);
std::string bash_completion(const CLI::App& program);
std::string zsh_completion(const CLI::App& program);

}  // namespace cli
