#include "cli/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "data/edit_distance.hpp"
#include "data/terminal.hpp"
#include "dem/contact/isa.hpp"

namespace cli {

CLI::Validator number_in(double low, double high, const std::string& what) {
  CLI::Validator validator(
      [low, high, what](std::string& text) {
        double value = 0.0;
        const char* begin = text.data() + (!text.empty() && text.front() == '+' ? 1 : 0);
        const auto [rest, error] = std::from_chars(begin, text.data() + text.size(), value);
        const bool number = error == std::errc{} && rest == text.data() + text.size() && std::isfinite(value);
        return number && value >= low && value <= high ? std::string() : fmt::format("'{}' is not {}", text, what);
      },
      "NUMBER", "");
  return validator;
}

CLI::Validator one_of(const std::vector<std::string>& choices) {
  return CLI::Validator(
      [choices](std::string& text) {
        if (std::find(choices.begin(), choices.end(), text) != choices.end()) return std::string();
        const auto near = data::nearest(text, choices);
        return fmt::format("'{}' is not one of {}{}", text, fmt::join(choices, ", "),
                           near ? fmt::format(" (did you mean '{}'?)", *near) : "");
      },
      fmt::format("{}", fmt::join(choices, "|")), "");
}

CLI::App* add_study_command(CLI::App& program, const std::string& name, const std::string& purpose,
                            const std::string& example, Common& common) {
  CLI::App* command = program.add_subcommand(name, purpose);
  command->add_option("STUDY", common.study, "study file, or folder that holds study.toml")->required();
  command->add_option("--out", common.out, "results folder (default: ./STUDY-NAME-results)");
  command
      ->add_option_function<std::string>(
          "--seed",
          [&common](const std::string& text) {
            std::uint64_t seed = 0;
            const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
            if (error != std::errc{} || rest != text.data() + text.size())
              throw CLI::ValidationError("--seed", fmt::format("'{}' is not a whole number from 0 to 2^64 - 1", text));
            common.seed = seed;
          },
          "seed of all random streams, instead of the study's")
      ->type_name("UINT");
  command->add_flag("--quiet", common.quiet, "no progress, no notes, no summary; warnings are said");
  command->add_flag("--json", common.json, "the result as JSON on stdout, and nothing else there");
  command->add_option("--set", common.set, "set a key of the study: contact.restitution=0.8")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  command->footer("Example: " + example);
  return command;
}

void add_isa_option(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--isa", dem::pin_isa,
          "instruction set of the contact forces: x86-64, x86-64-v3 or x86-64-v4 (default: the widest that the "
          "processor has); the result does not depend on it")
      ->check(one_of({"x86-64", "x86-64-v3", "x86-64-v4"}));
}

Workspace open_workspace(const Common& common) {
  Workspace workspace = campaign::open_workspace(common);
  for (const std::string& note : workspace.notes) say(common, note);
  return workspace;
}

void say(const Common& common, const std::string& text) {
  if (!common.quiet || text.starts_with("warning: ")) data::tell(text);
}

void answer(const Common& common, const std::string& text) {
  if (common.quiet) return;
  if (common.json)
    data::tell(text);
  else
    data::print_answer(text);
}

void print_json(const Common& common, const nlohmann::json& result) {
  if (!common.json) return;
  // Controls of C1 are valid in JSON as they are, but a terminal may obey them.
  std::string text;
  for (const char c : result.dump(1, ' ', false, nlohmann::json::error_handler_t::replace)) {
    const bool control = !text.empty() && text.back() == '\xc2' && static_cast<unsigned char>(c) < 0xa0 &&
                         static_cast<unsigned char>(c) >= 0x80;
    if (control)
      text.replace(text.size() - 1, 1, fmt::format("\\u{:04x}", static_cast<unsigned char>(c)));
    else
      text += c == '\x7f' ? std::string("\\u007f") : std::string(1, c);
  }
  data::print_result(text);
}

}  // namespace cli
