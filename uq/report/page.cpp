#include "uq/report/page.hpp"

#include <fmt/format.h>

#include "uq/report/element.hpp"

namespace uq::page {

namespace {

/// Ready HTML without its tags.
std::string without_tags(const std::string& html) {
  std::string plain;
  bool inside = false;
  for (const char c : html) {
    if (c == '<') inside = true;
    if (!inside) plain += c;
    if (c == '>') inside = false;
  }
  return plain;
}

}  // namespace

std::string text(std::string_view raw) {
  std::string safe = escape_html(raw);
  for (std::size_t at = safe.find("+-"); at != std::string::npos; at = safe.find("+-", at))
    safe.replace(at, 2, "\u00b1");
  return safe;
}

Cell number(std::string html) { return {std::move(html), "number"}; }

std::string html(const Table& table) {
  const auto cell = [](const char* tag, const char* scope, const Cell& content) {
    const std::string kind = *content.kind ? fmt::format(" class=\"{}\"", content.kind) : "";
    return fmt::format("<{0}{1}{2}>{3}</{0}>", tag, scope, kind, content.html);
  };
  std::string out = "<div class=\"wide\"><table>";
  if (!table.caption.empty()) out += "<caption>" + table.caption + "</caption>";
  if (!table.head.empty()) {
    out += "<thead><tr>";
    for (const Cell& content : table.head) out += cell("th", " scope=\"col\"", content);
    out += "</tr></thead>";
  }
  out += "<tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      // On a narrow screen each row is a card, and its cells say what they are (style.hpp).
      const std::string label = i < table.head.size() ? without_tags(table.head[i].html) : "";
      out += i == 0          ? cell("th", " scope=\"row\"", row[i])
             : label.empty() ? cell("td", "", row[i])
                             : cell("td", fmt::format(" data-label=\"{}\"", label).c_str(), row[i]);
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string figure(const Figure& drawing, const std::string& caption, const Context& context) {
  return fmt::format(
      "<figure>\n{0}\n<figcaption>{1} <span class=\"files\">Data and script: <a href=\"figures/{2}.dat\">{2}.dat</a>, "
      "<a href=\"figures/{2}.gp\">.gp</a></span></figcaption>\n</figure>\n",
      draw(drawing, context.figures, context.options.gnuplot), caption, drawing.stem);
}

std::string badge(Verdict verdict) {
  switch (verdict) {
    case Verdict::identified:
      return "<span class=\"badge good\">\u2713 identified</span>";
    case Verdict::weakly_identified:
      return "<span class=\"badge fair\">\u223c weakly identified</span>";
    case Verdict::several_values:
      return "<span class=\"badge fair\">\u2016 several values</span>";
    case Verdict::not_identified:
      return "<span class=\"badge poor\">\u2717 not identified</span>";
    case Verdict::does_not_fit:
      break;
  }
  return "<span class=\"badge fail\">! model does not fit</span>";
}

std::string badge(SurrogateWord word) {
  const bool good = word == SurrogateWord::good, caution = word == SurrogateWord::caution;
  return fmt::format("<span class=\"badge {}\">{} {}</span>", good ? "good" : (caution ? "fair" : "fail"),
                     good ? "\u2713" : (caution ? "\u223c" : "!"), to_text(word));
}

std::string case_id(std::size_t index, const CaseReport& result) {
  return fmt::format("case-{}-{}", index + 1, slug(result.name));
}

}  // namespace uq::page
