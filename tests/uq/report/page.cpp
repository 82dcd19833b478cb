#include "uq/report/page.hpp"

#include <catch2/catch.hpp>

using namespace uq::page;

namespace {

std::string shown(const Markup& markup) { return markup.html(); }

}  // namespace

TEST_CASE("a table's cells are set as their column says, unless they say otherwise, and carry its name") {
  const Table table{.caption = "a < b",
                    .columns = {{"Run"}, {"R & D", number}, {"What", lengthy}},
                    .rows = {{"1", "2 +- 1", "<b>"}, {"2", {tag::strong("3"), nowrap}, {"", plain}}}};
  CHECK(shown(table) ==
        "<div class=\"wide\"><table><caption>a &lt; b</caption>\n"
        "<thead><tr><th scope=\"col\">Run</th><th scope=\"col\" class=\"number\">R &amp; D</th>"
        "<th scope=\"col\">What</th></tr>\n</thead>\n"
        "<tbody><tr><th scope=\"row\">1</th><td data-label=\"R &amp; D\" class=\"number\">2 \u00b1 1</td>"
        "<td data-label=\"What\" class=\"long\">&lt;b&gt;</td></tr>\n"
        "<tr><th scope=\"row\">2</th><td data-label=\"R &amp; D\" class=\"nowrap\"><strong>3</strong></td>"
        "<td data-label=\"What\"></td></tr>\n</tbody>\n</table>\n</div>\n");
}

TEST_CASE("a table without names has no headings, and one with more cells than columns shows them") {
  CHECK(shown(Table{.columns = {{""}, {"", lengthy}}, .rows = {{"a", "b", "c"}}}) ==
        "<div class=\"wide\"><table><tbody><tr><th scope=\"row\">a</th><td class=\"long\">b</td><td>c</td></tr>\n"
        "</tbody>\n</table>\n</div>\n");
}

TEST_CASE("a table of more rows than are shown openly is folded away") {
  const uq::HtmlOptions options{.rows_shown_openly = 1};
  const Context context{.options = options, .figures = ""};
  Table table{.columns = {{"Run"}}, .rows = {{"1"}}};
  CHECK(shown(behind_figure(table, context)) == shown(table));
  table.rows.push_back({"2"});
  CHECK(shown(behind_figure(table, context)) ==
        "<details><summary>The numbers behind the figure</summary>\n" + shown(table) + "</details>\n");
}
