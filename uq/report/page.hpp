#pragma once
// Pieces of report.html, for html*.cpp alone. Every piece of text that a file or a user
// supplied goes through text().
#include <string>
#include <string_view>
#include <vector>

#include "uq/findings/wording.hpp"
#include "uq/report/html.hpp"

namespace uq::page {

/// Where figures go and what draws them.
struct Context {
  const HtmlOptions& options;
  std::string figures;  ///< folder
};

/// Words from outside made safe, with a plus-minus sign where they write "+-".
std::string text(std::string_view raw);

/// A table's cell: ready HTML and its class ("number", "nowrap", "long" or "").
struct Cell {
  std::string html;
  const char* kind = "";
};
Cell number(std::string html);

struct Table {
  std::string caption;  ///< ready HTML; may be empty
  std::vector<Cell> head;
  std::vector<std::vector<Cell>> rows;  ///< the first cell of a row is its heading
};
std::string html(const Table& table);

/// Draws the figure and sets it with its caption (ready HTML).
std::string figure(const Figure& figure, const std::string& caption, const Context& context);

std::string badge(Verdict verdict);
std::string badge(SurrogateWord word);

/// A case's place in the page: "case-2-carrier". The index keeps two names with one slug apart.
std::string case_id(std::size_t index, const CaseReport& result);

/// Of a case: its parameters' joint posterior and what is traded; `id` as in case_id.
std::string joint_part(const CaseReport& result, const std::string& id, const Context& context);
/// Runs of the simulation at points of the posterior beside the surrogate; nothing where there are none.
std::string verification_part(const CaseReport& result, const std::string& id, const Context& context);
/// What to measure next; nothing where no plan was made.
std::string plan_part(const CaseReport& result, const std::string& id, const Context& context);
/// Traces and ranks of its chains, folded away.
std::string chains_part(const CaseReport& result, const std::string& id, const Context& context);
std::string case_section(const CaseReport& result, std::size_t index, const Context& context);
/// The terms of the page.
std::string glossary_section();
/// Where the runs lie; nothing where no material varies two inputs.
std::string design_section(const std::vector<DesignReport>& designs, const Context& context);
std::string surrogate_section(const std::vector<SurrogateReport>& surrogates, const Context& context);

}  // namespace uq::page
