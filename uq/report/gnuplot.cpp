#include "uq/report/gnuplot.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/file_name.hpp"
#include "data/program.hpp"
#include "uq/report/element.hpp"

namespace uq {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
}

/// Cuts out every element `name`, with what it holds.
void remove_elements(std::string& text, const std::string& name) {
  const std::string closing = "</" + name + ">";
  for (std::size_t at = 0; (at = text.find("<" + name, at)) != std::string::npos;) {
    const std::size_t end = text.find(closing, at);
    if (end == std::string::npos) return;
    text.erase(at, end + closing.size() - at);
  }
}

}  // namespace

std::string gnuplot_text(std::string_view text) {
  std::string literal = "'";
  for (const char c : text) {
    if (c == '\'') literal += '\'';
    literal += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return literal + "'";
}

std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view alt) {
  const std::size_t start = svg.find("<svg");
  if (start == std::string_view::npos) return {};
  std::string text(svg.substr(start));
  remove_elements(text, "script");
  remove_elements(text, "title");
  remove_elements(text, "desc");
  const std::string id = std::string(prefix) + "-";
  for (const char quote : {'"', '\''}) {
    replace_all(text, fmt::format(" id={}", quote), fmt::format(" id={}{}", quote, id));
    replace_all(text, fmt::format("href={}#", quote), fmt::format("href={}#{}", quote, id));
  }
  replace_all(text, "url(#", "url(#" + id);
  text.insert(4, fmt::format(" role=\"img\" aria-label=\"{}\"", page::escape_html(alt)));
  return text;
}

std::string draw(const Figure& figure, const std::string& folder, const GnuplotOptions& options) {
  namespace fs = std::filesystem;
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) {
    throw data::InputError(data::ExitStatus::cannot_write,
                           {folder, "cannot make the folder: " + failure.message(), "choose another --out"});
  }
  if (!data::is_file_name(figure.stem)) throw std::invalid_argument("a figure's stem is no slug: " + figure.stem);
  const std::string script = fmt::format(
      "set encoding utf8\n"
      "set terminal svg size {},{} dynamic noenhanced font 'sans-serif,13' linewidth 1.2 background rgb 'white'\n"
      "if (!exists('to_stdout')) set output '{}.svg'\n{}\nunset output\n",
      figure.width, figure.height, figure.stem, figure.script);
  const std::string base = (fs::path(folder) / figure.stem).string();
  for (const char* ending : {".dat", ".gp", ".svg"}) data::require_replaceable(base + ending);
  data::write_atomically(base + ".dat", figure.data);
  data::write_atomically(base + ".gp", script);

  // The picture comes through a pipe, which no full disk cuts off. "-d" keeps the user's and the system's start-up
  // files out of the figures.
  const data::ProgramEnd result =
      data::run_program({.words = {options.program, "-d", "-e", "to_stdout=1", figure.stem + ".gp"}, .folder = folder});
  if (result.start_error != 0) {
    throw data::cannot_start(options.program, result,
                             "the report's figures are drawn with it; install it: apt-get install gnuplot-nox");
  }
  const std::string& svg = result.out;
  if (result.exit_status != 0 || svg.find("</svg>") == std::string::npos) {
    throw data::InputError(
        data::ExitStatus::missing_program,
        {base + ".gp", fmt::format("gnuplot failed (exit status {}) and said: {}", result.exit_status, result.err),
         "demcal needs gnuplot 5.2 or later with the svg terminal: apt-get install gnuplot-nox"});
  }
  data::write_atomically(base + ".svg", svg);
  return inline_svg(svg, figure.stem, figure.alt);
}

}  // namespace uq
