#pragma once
// Markup of the page as values. Text becomes markup by being escaped, and only what is named Raw is taken as it is, so
// that no text enters the page unescaped. An element with its attributes is called with its children:
//   tag::ul.is("note")(tag::li("1 < 2"), tag::li(tag::strong(name), " is free"))
#include <concepts>
#include <string>
#include <string_view>
#include <utility>

namespace uq::page {

/// Markup made elsewhere (a drawn figure, a style sheet).
struct Raw {
  explicit Raw(std::string ready) : html(std::move(ready)) {}
  std::string html;
};

/// Text made safe between tags and inside quoted attributes. Control characters are dropped, line breaks and tabs
/// become spaces, and what is no UTF-8 becomes U+FFFD.
std::string escape_html(std::string_view text);

class Markup {
 public:
  Markup() = default;
  Markup(Raw raw) : html_(std::move(raw.html)) {}
  /// Text, escaped, with a plus-minus sign where it writes "+-".
  template <std::convertible_to<std::string_view> Text>
  Markup(const Text& text) : html_(escaped(text)) {}

  Markup& operator+=(const Markup& more) {
    html_ += more.html_;
    return *this;
  }
  friend Markup operator+(Markup first, const Markup& second) { return std::move(first += second); }

  bool empty() const { return html_.empty(); }
  const std::string& html() const { return html_; }
  static std::string escaped(std::string_view text);

 private:
  std::string html_;
};

/// An element that waits for its children.
class Element {
 public:
  /// A block ends its line of the file, a part stands within one; a void element holds nothing.
  enum class Kind { block, part, void_block };

  Element(const char* name, Kind kind) : name_(name), kind_(kind) {}
  /// The element with one more attribute; unchanged where the value is empty.
  Element with(const char* attribute, std::string_view value) const;
  Element is(std::string_view classes) const { return with("class", classes); }

  template <class... Child>
  Markup operator()(const Child&... children) const {
    return around((Markup() + ... + Markup(children)));
  }
  /// The element around its content; nothing where the content is empty.
  Markup unless_empty(const Markup& content) const { return content.empty() ? Markup() : around(content); }

 private:
  Markup around(const Markup& content) const;

  std::string name_, attributes_;
  Kind kind_;
};

/// One piece of markup for each item of a list: each(notes, tag::li).
template <class List, class Piece>
Markup each(const List& list, const Piece& piece) {
  Markup all;
  for (const auto& one : list) all += piece(one);
  return all;
}

namespace tag {
using enum Element::Kind;
inline const Element html{"html", block}, head{"head", block}, title{"title", block}, style{"style", block};
inline const Element body{"body", block}, header{"header", block}, main{"main", block}, nav{"nav", block};
inline const Element section{"section", block}, div{"div", block}, h1{"h1", block}, h2{"h2", block}, h3{"h3", block};
inline const Element p{"p", block}, ul{"ul", block}, ol{"ol", block}, li{"li", block}, dl{"dl", block}, dd{"dd", block};
inline const Element table{"table", block}, caption{"caption", block}, thead{"thead", block}, tbody{"tbody", block};
inline const Element tr{"tr", block}, figure{"figure", block}, figcaption{"figcaption", block};
inline const Element details{"details", block}, summary{"summary", block};
inline const Element a{"a", part}, span{"span", part}, strong{"strong", part}, dt{"dt", part}, td{"td", part},
    th{"th", part};
inline const Element meta{"meta", void_block}, br{"br", void_block};
}  // namespace tag

}  // namespace uq::page
