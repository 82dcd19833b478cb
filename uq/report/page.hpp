#pragma once
// Pieces of report.html, for html*.cpp alone. A part or section of which nothing is known is empty markup.
#include <optional>
#include <string>
#include <vector>

#include "uq/report/element.hpp"
#include "uq/report/html.hpp"
#include "uq/report/numbers.hpp"

namespace uq::page {

/// The place where figures go, and the options of what draws them.
struct Context {
  const HtmlOptions& options;
  std::string figures;  ///< folder of the figures
};

/// How a cell is set: a number to the right, lengthy words broken anywhere.
enum class CellKind { plain, number, nowrap, lengthy };
using enum CellKind;

struct Column {
  std::string name;
  CellKind kind = plain;  ///< kind of the column's cells; the heading of numbers is set like them
};

struct Cell {
  template <std::convertible_to<Markup> Content>
  Cell(const Content& shown, std::optional<CellKind> other_kind = {}) : content(shown), kind(other_kind) {}
  Markup content;
  std::optional<CellKind> kind;  ///< kind of the cell where it differs from its column's
};

struct Table {
  std::string caption;
  std::vector<Column> columns;          ///< without names they have no heading
  std::vector<std::vector<Cell>> rows;  ///< the first cell of a row is its heading
  operator Markup() const;
};
/// A long table of numbers that a figure shows, folded away.
Markup behind_figure(const Table& table, const Context& context);

/// Draws the figure and sets it with its caption.
Markup figure(const Figure& figure, const Markup& caption, const Context& context);
/// Figures side by side.
Markup side_by_side(const Markup& figures);

Markup badge(Verdict verdict);
Markup badge(SurrogateWord word);
/// "Finding" and what it is, as an entry of a list of definitions; nothing without words.
Markup entry(const char* heading, const std::string& words);
/// A link to a place of the page.
Markup link(const std::string& id, const std::string& words);

/// A case's place in the page: "case-2-carrier". The index keeps two names with one slug apart.
std::string case_id(std::size_t index, const CaseReport& result);

// The parts of a case; `id` as in case_id.
/// What is measured beside the model: fit, predictions, discrepancy.
Markup data_part(const CaseReport& result, const std::string& id, const Context& context);
/// The joint posterior of the case's parameters, and what is traded.
Markup joint_part(const CaseReport& result, const std::string& id, const Context& context);
/// Runs of the simulation at points of the posterior beside the surrogate.
Markup verification_part(const CaseReport& result, const std::string& id, const Context& context);
/// What to measure next.
Markup plan_part(const CaseReport& result, const std::string& id, const Context& context);
Markup case_section(const CaseReport& result, const std::string& id, const Context& context);

/// The terms of the page.
Markup glossary_section();
/// Where the runs lie; nothing where no material varies two inputs.
Markup design_section(const std::vector<DesignReport>& designs, const Context& context);
Markup surrogate_section(const std::vector<SurrogateReport>& surrogates, const Context& context);
Markup sampler_section(const std::vector<CaseReport>& cases, const Context& context);

}  // namespace uq::page
