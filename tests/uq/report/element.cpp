#include "uq/report/element.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "data/text_encoding.hpp"

using namespace uq::page;

namespace {

/// What a reader of HTML sees of escaped text: the five entities undone.
std::string read(std::string text) {
  const std::pair<const char*, const char*> entities[] = {
      {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}};
  for (const auto& [entity, sign] : entities)
    for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos; ++at)
      text.replace(at, std::string(entity).size(), sign);
  return text;
}

/// What stands between `before` and `after`, which are all that is around it.
std::string between(const std::string& html, const std::string& before, const std::string& after) {
  REQUIRE(html.size() >= before.size() + after.size());
  REQUIRE(html.starts_with(before));
  REQUIRE(html.ends_with(after));
  return html.substr(before.size(), html.size() - before.size() - after.size());
}

}  // namespace

TEST_CASE("escaped text holds no markup and no control character") {
  CHECK(escape_html("<b a=\"1\" c='2'>&\x01\n") == "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp; ");
}

TEST_CASE("hostile text stays text, as a child and as an attribute, alone and in any pair") {
  // What ends tags, attributes, comments, scripts and styles; what steers terminals; what is no UTF-8 (a lone byte, a
  // cut character, an overlong '<', a surrogate), which may swallow the quote behind it.
  const std::vector<std::string> pieces{"<",         ">",
                                        "&",         "\"",
                                        "'",         "`",
                                        "=",         "</p>",
                                        "<!--",      "-->",
                                        "]]>",       "&lt;",
                                        "&#60;",     "<script>",
                                        "</style>",  "\" onload=\"x",
                                        "' x='",     "\n",
                                        "\r",        "\t",
                                        "\x1b[2J",   "\x7f",
                                        "\u009b31m", std::string(1, '\0'),
                                        "\x80",      "\xc3",
                                        "\xe2\x82",  "\xf0\x9f",
                                        "\xc0\xbc",  "\xed\xa0\x80",
                                        "\xff",      "\u00b5",
                                        "\u202e",    "\U0001f600"};
  for (const std::string& first : pieces)
    for (const std::string& second : pieces) {
      const std::string hostile = first + second;
      CAPTURE(hostile);
      const std::string child = between(tag::p(hostile).html(), "<p>", "</p>\n");
      const std::string value = between(tag::a.with("href", hostile)("x").html(), "<a href=\"", "\">x</a>");
      CHECK(child == value);
      CHECK(child.find_first_of("<>\"'") == std::string::npos);
      CHECK(data::is_utf8(child));
      for (std::size_t at = 0; at < child.size();) {
        const data::CodePoint one = data::utf8_at(child, at);
        CHECK_FALSE((one.code < 0x20 || (one.code >= 0x7f && one.code < 0xa0)));
        at += one.length;
      }
      // Each '&' begins one of the five entities, and undone they give what was written, but for what cannot be shown.
      std::string written;
      for (std::size_t at = 0; at < hostile.size();) {
        const data::CodePoint one = data::utf8_at(hostile, at);
        const bool control = one.code < 0x20 || (one.code >= 0x7f && one.code < 0xa0);
        if (!one.valid)
          written += "\ufffd";
        else if (one.code == '\n' || one.code == '\t')
          written += ' ';
        else if (!control)
          written += hostile.substr(at, one.length);
        at += one.length;
      }
      CHECK(read(child) == written);
    }
}

TEST_CASE("only what is named Raw is taken as it is, and a number is no markup") {
  CHECK(Markup(Raw("<svg/>")).html() == "<svg/>");
  CHECK(tag::p(Raw("<svg/>"), "<svg/>").html() == "<p><svg/>&lt;svg/&gt;</p>\n");
  CHECK_FALSE(std::is_convertible_v<std::string, Raw>);
  CHECK_FALSE(std::is_convertible_v<const char*, Raw>);
  CHECK_FALSE(std::is_constructible_v<Markup, int>);
  CHECK_FALSE(std::is_convertible_v<Markup, std::string>);
}

TEST_CASE("text and markup join as markup, from either side, and are escaped once") {
  const Markup strong = tag::strong("a & b");
  CHECK((strong + " < c").html() == "<strong>a &amp; b</strong> &lt; c");
  CHECK((std::string("0 < ") + strong).html() == "0 &lt; <strong>a &amp; b</strong>");
  CHECK(tag::span(strong).html() == "<span><strong>a &amp; b</strong></span>");
}

TEST_CASE("elements nest, keep the order of children and attributes, and leave out empty attributes") {
  CHECK(
      tag::section.with("id", "x").is("y")(tag::h2("One"), tag::p("two ", tag::strong("three"), "."), "four").html() ==
      "<section id=\"x\" class=\"y\"><h2>One</h2>\n<p>two <strong>three</strong>.</p>\nfour</section>\n");
  CHECK(tag::td.with("data-label", "").is("")().html() == "<td></td>");
  CHECK(tag::p.is("soft")("a").html() + tag::p("b").html() == "<p class=\"soft\">a</p>\n<p>b</p>\n");
}

TEST_CASE("a void element has no end and refuses children") {
  CHECK(tag::meta.with("charset", "utf-8")().html() == "<meta charset=\"utf-8\">\n");
  CHECK(tag::br().html() == "<br>\n");
  CHECK_THROWS_AS(tag::br("x"), std::logic_error);
}

TEST_CASE("a list gives a piece each, and an element may leave itself out where it would hold nothing") {
  const std::vector<std::string> notes{"a < b", "c"};
  CHECK(tag::ul.unless_empty(each(notes, tag::li)).html() == "<ul><li>a &lt; b</li>\n<li>c</li>\n</ul>\n");
  CHECK(tag::ul.unless_empty(each(std::vector<std::string>(), tag::li)).empty());
  CHECK_FALSE(tag::ul().empty());
}

TEST_CASE("a plus-minus sign is set where text writes +-") {
  CHECK(tag::p("1 +- 2").html() == "<p>1 \u00b1 2</p>\n");
  CHECK(tag::a.with("title", "+-+-")().html() == "<a title=\"\u00b1\u00b1\"></a>");
}
