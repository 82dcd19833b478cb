#include "uq/report/element.hpp"

#include <stdexcept>

#include "data/text_encoding.hpp"

namespace uq::page {

std::string escape_html(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const auto [code, length, valid] = data::utf8_at(text, at);
    if (!valid)
      safe += "\ufffd";
    else if (code == '&')
      safe += "&amp;";
    else if (code == '<')
      safe += "&lt;";
    else if (code == '>')
      safe += "&gt;";
    else if (code == '"')
      safe += "&quot;";
    else if (code == '\'')
      safe += "&#39;";
    else if (code == '\n' || code == '\t')
      safe += ' ';
    else if (code >= 0xa0 || (code >= 0x20 && code < 0x7f))
      safe += text.substr(at, length);
    at += length;
  }
  return safe;
}

std::string Markup::escaped(std::string_view text) {
  std::string safe = escape_html(text);
  for (std::size_t at = 0; (at = safe.find("+-", at)) != std::string::npos;) safe.replace(at, 2, "\u00b1");
  return safe;
}

Element Element::with(const char* attribute, std::string_view value) const {
  Element more = *this;
  if (!value.empty()) more.attributes_ += " " + std::string(attribute) + "=\"" + Markup::escaped(value) + "\"";
  return more;
}

Markup Element::around(const Markup& content) const {
  std::string html = "<" + name_ + attributes_ + ">";
  if (kind_ != Kind::void_block)
    html += content.html() + "</" + name_ + ">";
  else if (!content.empty())
    throw std::logic_error("the element " + name_ + " holds nothing");
  if (kind_ != Kind::part) html += '\n';
  return Raw(std::move(html));
}

}  // namespace uq::page
