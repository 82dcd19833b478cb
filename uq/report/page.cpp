#include "uq/report/page.hpp"

#include <algorithm>

namespace uq::page {

namespace {

const char* class_of(CellKind kind) {
  switch (kind) {
    case number:
      return "number";
    case nowrap:
      return "nowrap";
    case lengthy:
      return "long";
    case plain:
      break;
  }
  return "";
}

Markup badge(const std::string& colour, const char* sign, const char* word) {
  return tag::span.is("badge " + colour)(sign, " ", word);
}

}  // namespace

Table::operator Markup() const {
  const Column none;
  const auto column_of = [&](std::size_t i) -> const Column& { return i < columns.size() ? columns[i] : none; };
  const bool headed = std::any_of(columns.begin(), columns.end(), [](const Column& one) { return !one.name.empty(); });
  const Markup names = each(columns, [](const Column& one) {
    return tag::th.with("scope", "col").is(class_of(one.kind == number ? number : plain))(one.name);
  });
  const Markup body = each(rows, [&](const std::vector<Cell>& row) {
    Markup cells;
    for (std::size_t i = 0; i < row.size(); ++i) {
      // On a narrow screen each row is a card, and its cells say what they are (style.hpp).
      const Element cell = i == 0 ? tag::th.with("scope", "row") : tag::td.with("data-label", column_of(i).name);
      cells += cell.is(class_of(row[i].kind.value_or(column_of(i).kind)))(row[i].content);
    }
    return tag::tr(cells);
  });
  return tag::div.is("wide")(
      tag::table(tag::caption.unless_empty(caption), headed ? tag::thead(tag::tr(names)) : Markup(), tag::tbody(body)));
}

Markup behind_figure(const Table& table, const Context& context) {
  if (table.rows.size() <= context.options.rows_shown_openly) return table;
  return tag::details(tag::summary("The numbers behind the figure"), table);
}

Markup figure(const Figure& drawing, const Markup& caption, const Context& context) {
  const auto file = [&](const char* ending, const std::string& words) {
    return tag::a.with("href", "figures/" + drawing.stem + ending)(words);
  };
  return tag::figure(Raw(draw(drawing, context.figures, context.options.gnuplot)),
                     tag::figcaption(caption, " ",
                                     tag::span.is("files")("Data and script: ", file(".dat", drawing.stem + ".dat"),
                                                           ", ", file(".gp", ".gp"))));
}

Markup side_by_side(const Markup& figures) { return tag::div.is("pair").unless_empty(figures); }

Markup badge(Verdict verdict) {
  const char* const word = to_text(verdict);
  switch (verdict) {
    case Verdict::identified:
      return badge("good", "\u2713", word);
    case Verdict::weakly_identified:
      return badge("fair", "\u223c", word);
    case Verdict::several_values:
      return badge("fair", "\u2016", word);
    case Verdict::not_identified:
      return badge("poor", "\u2717", word);
    case Verdict::does_not_fit:
      break;
  }
  return badge("fail", "!", word);
}

Markup badge(SurrogateWord word) {
  const bool good = word == SurrogateWord::good, caution = word == SurrogateWord::caution;
  return badge(good ? "good" : (caution ? "fair" : "fail"), good ? "\u2713" : (caution ? "\u223c" : "!"),
               to_text(word));
}

Markup entry(const char* heading, const std::string& words) {
  return words.empty() ? Markup() : tag::dt(heading) + tag::dd(words);
}

Markup link(const std::string& id, const std::string& words) { return tag::a.with("href", "#" + id)(words); }

std::string case_id(std::size_t index, const CaseReport& result) {
  return fmt::format("case-{}-{}", index + 1, slug(result.name));
}

}  // namespace uq::page
