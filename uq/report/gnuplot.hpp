#pragma once
// Figures drawn by gnuplot as a child process, without a shell, and brought into a page as inline SVG.
#include <string>
#include <string_view>

namespace uq {

/// What gnuplot is given. `script` reads "STEM.dat" and writes nothing by itself: terminal and output are put before
/// it.
struct Figure {
  std::string stem;    ///< file name without ending, also the prefix of the ids in the page; a slug
  std::string script;  ///< gnuplot commands
  std::string data;    ///< blocks headed "# name", two blank lines between them
  std::string alt;     ///< what the figure shows, for those who do not see it
  int width = 700;     ///< px
  int height = 420;    ///< px
};

struct GnuplotOptions {
  std::string program = "gnuplot";  ///< name or path; looked up in PATH
};

/// A gnuplot string that is taken literally: neither quotes, backquotes nor macros in `text` do anything.
std::string gnuplot_text(std::string_view text);

/// Writes STEM.gp and STEM.dat into `folder`, has gnuplot draw STEM.svg there, and returns it ready for a page.
/// Throws data::InputError: 69 gnuplot is missing or fails (with what it said), 73 the files cannot be written.
std::string draw(const Figure& figure, const std::string& folder, const GnuplotOptions& options);

/// An SVG document made fit to stand inside a page: no prolog, no script, every id prefixed so that two figures do not
/// share one, a role and a description.
std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view alt);

}  // namespace uq
