// Windows-1252 stands for Latin-1: it fills 0x80 to 0x9f, where Latin-1 has control characters that no table holds.
#include "data/text_encoding.hpp"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <optional>

#include "data/error.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

[[noreturn]] void refuse(const std::string& name, std::string what) {
  refuse_data(name, std::move(what), "save the table as CSV in UTF-8");
}

void append_utf8(std::string& text, std::uint32_t code) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xc0 | code >> 6);
    text += static_cast<char>(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    text += static_cast<char>(0xe0 | code >> 12);
    text += static_cast<char>(0x80 | (code >> 6 & 0x3f));
    text += static_cast<char>(0x80 | (code & 0x3f));
  } else {
    text += static_cast<char>(0xf0 | code >> 18);
    text += static_cast<char>(0x80 | (code >> 12 & 0x3f));
    text += static_cast<char>(0x80 | (code >> 6 & 0x3f));
    text += static_cast<char>(0x80 | (code & 0x3f));
  }
}

std::uint8_t byte(std::string_view text, std::size_t at) { return static_cast<std::uint8_t>(text[at]); }

std::string from_utf16(std::string_view bytes, bool big, const std::string& name) {
  if (bytes.size() % 2 != 0) refuse(name, "is UTF-16, but has an odd number of bytes: it was cut off");
  const auto unit = [&](std::size_t at) {
    return static_cast<std::uint32_t>(big ? byte(bytes, at) << 8 | byte(bytes, at + 1)
                                          : byte(bytes, at + 1) << 8 | byte(bytes, at));
  };
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 2) {
    std::uint32_t code = unit(at);
    if (code >= 0xd800 && code < 0xe000) {
      const std::uint32_t low = at + 2 < bytes.size() ? unit(at + 2) : 0;
      if (code >= 0xdc00 || low < 0xdc00 || low >= 0xe000) refuse(name, "looks like UTF-16, but is no text");
      code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
      at += 2;
    }
    append_utf8(text, code);
  }
  return text;
}

std::string from_windows_1252(std::string_view bytes) {
  static constexpr std::array<std::uint16_t, 32> upper{0x20ac, 0x0081, 0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021,
                                                       0x02c6, 0x2030, 0x0160, 0x2039, 0x0152, 0x008d, 0x017d, 0x008f,
                                                       0x0090, 0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2013, 0x2014,
                                                       0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0x009d, 0x017e, 0x0178};
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    const std::uint8_t c = byte(bytes, at);
    append_utf8(text, c >= 0x80 && c < 0xa0 ? upper[c - 0x80u] : c);
  }
  return text;
}

/// Whether all that is not ASCII is Shift-JIS, with kana or kanji of the first plane or wide brackets among it. Their
/// first byte, 0x81 to 0x9f, is a control character in Latin-1.
bool is_shift_jis(std::string_view bytes) {
  bool japanese = false;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    const std::uint8_t c = byte(bytes, at);
    if (c < 0x80 || (c >= 0xa1 && c <= 0xdf)) continue;  // ASCII, half-width katakana
    if (c == 0x80 || c == 0xa0 || c > 0xfc || at + 1 == bytes.size()) return false;
    const std::uint8_t second = byte(bytes, ++at);
    if (second < 0x40 || second == 0x7f || second > 0xfc) return false;
    const bool bracket = c == 0x81 && (second == 0x69 || second == 0x6a || second == 0x6d || second == 0x6e);
    japanese = japanese || (c >= 0x82 && c <= 0x9f) || bracket;
  }
  return japanese;
}

/// Whether all that is not ASCII is pairs of bytes of the Chinese and Korean national standards (GB 2312, KS X 1001),
/// most of them letters and not signs. Words of Latin-1 have single letters with an accent.
bool is_gb_or_ks(std::string_view bytes) {
  std::size_t pairs = 0, letters = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    const std::uint8_t c = byte(bytes, at);
    if (c < 0x80) continue;
    if (c < 0xa1 || c > 0xf7 || at + 1 == bytes.size() || byte(bytes, at + 1) < 0xa1) return false;
    ++pairs, ++at;
    letters += c >= 0xb0;
  }
  return letters >= 2 && 2 * letters >= pairs;
}

/// Whether the pairs are Korean syllables rather than Chinese signs: those stand in the first half of the letters.
bool is_korean(std::string_view bytes) {
  for (std::size_t at = 0; at < bytes.size(); ++at)
    if (byte(bytes, at) >= 0x80 && byte(bytes, at++) > 0xc8) return false;
  return true;
}

/// The text in UTF-8, by the system's tables; nothing where it has none of that name, or the bytes are no such text.
std::optional<std::string> from_charset(std::string_view bytes, const char* charset) {
  const iconv_t converter = iconv_open("UTF-8", charset);
  if (converter == reinterpret_cast<iconv_t>(-1)) return {};
  std::string text(4 * bytes.size() + 16, '\0'), copy(bytes);
  char *from = copy.data(), *to = text.data();
  std::size_t from_left = copy.size(), to_left = text.size();
  const bool failed = iconv(converter, &from, &from_left, &to, &to_left) == static_cast<std::size_t>(-1);
  iconv_close(converter);
  if (failed) return {};
  text.resize(text.size() - to_left);
  return text;
}

/// Units in brackets that are not ASCII, in the beginning of a text.
std::size_t known_units(std::string_view text) {
  std::size_t known = 0;
  text = text.substr(0, 20000);
  for (const char* marks : {"[]", "()"})
    for (std::size_t open = 0; (open = text.find(marks[0], open)) != std::string_view::npos; ++open) {
      const std::string_view unit = text.substr(open + 1, text.find(marks[1], open) - open - 1);
      const bool ascii =
          std::all_of(unit.begin(), unit.end(), [](char c) { return static_cast<std::uint8_t>(c) < 0x80; });
      known += !ascii && unit.size() < 40 && is_unit(unit);
    }
  return known;
}

/// Whether what may be Shift-JIS is rather Windows-1252: more of its units are known so, or its pairs of bytes are a
/// quotation mark or a dash before a letter, as in "Operator's".
bool is_rather_windows_1252(std::string_view bytes, const std::string& japanese) {
  const std::size_t western = known_units(from_windows_1252(bytes)), eastern = known_units(japanese);
  if (western != eastern) return western > eastern;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    const std::uint8_t c = byte(bytes, at);
    if (c < 0x80 || c > 0x9f) continue;
    const bool mark = c == 0x80 || c == 0x85 || (c >= 0x91 && c <= 0x97) || c == 0x99;
    if (!mark || at + 1 == bytes.size() || byte(bytes, at + 1) >= 0x80) return false;
  }
  return true;
}

/// ASCII in UTF-16 has a zero in every other byte.
bool looks_like_utf16(std::string_view bytes, bool big) {
  const std::size_t pairs = std::min<std::size_t>(bytes.size() / 2, 256);
  std::size_t zeros = 0, letters = 0;
  for (std::size_t i = 0; i < pairs; ++i) {
    zeros += byte(bytes, 2 * i + (big ? 0 : 1)) == 0;
    letters += byte(bytes, 2 * i + (big ? 1 : 0)) != 0;
  }
  return pairs > 2 && letters > 9 * pairs / 10 && zeros > 9 * pairs / 10;
}

}  // namespace

CodePoint utf8_at(std::string_view text, std::size_t at) {
  const std::uint8_t first = byte(text, at);
  if (first < 0x80) return {first, 1, true};
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || at + length > text.size()) return {first, 1, false};
  std::uint32_t code = first & (0xffu >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    const std::uint8_t next = byte(text, at + k);
    if ((next & 0xc0) != 0x80) return {first, 1, false};
    code = code << 6 | (next & 0x3fu);
  }
  constexpr std::array<std::uint32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
  if (code < smallest[length] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {first, 1, false};
  return {code, length, true};
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint next = utf8_at(text, at);
    if (!next.valid) return false;
    at += next.length;
  }
  return true;
}

DecodedText decode_text(std::string_view bytes, const std::string& name) {
  const auto begins = [&](std::string_view mark) { return bytes.substr(0, mark.size()) == mark; };
  if (begins({"\xff\xfe\0\0", 4}) || begins({"\0\0\xfe\xff", 4})) refuse(name, "is UTF-32");
  if (begins("\xff\xfe")) return {from_utf16(bytes.substr(2), false, name), "UTF-16, little endian"};
  if (begins("\xfe\xff")) return {from_utf16(bytes.substr(2), true, name), "UTF-16, big endian"};
  if (begins("\xef\xbb\xbf")) {
    bytes.remove_prefix(3);
    if (!is_utf8(bytes)) return {from_windows_1252(bytes), "Latin-1, although it begins as UTF-8"};
    return {std::string(bytes), ""};
  }
  if (looks_like_utf16(bytes, false)) return {from_utf16(bytes, false, name), "UTF-16, little endian"};
  if (looks_like_utf16(bytes, true)) return {from_utf16(bytes, true, name), "UTF-16, big endian"};
  if (is_utf8(bytes)) return {std::string(bytes), ""};
  if (is_shift_jis(bytes))
    if (std::optional<std::string> japanese = from_charset(bytes, "CP932");
        japanese && !is_rather_windows_1252(bytes, *japanese))
      return {std::move(*japanese), "Shift-JIS"};
  const std::size_t western = known_units(from_windows_1252(bytes));
  if (is_gb_or_ks(bytes)) {
    const bool korean = is_korean(bytes);
    if (std::optional<std::string> text = from_charset(bytes, korean ? "CP949" : "GB18030");
        text && known_units(*text) >= western)
      return {std::move(*text), korean ? "EUC-KR" : "GBK"};
  }
  if (std::optional<std::string> text = from_charset(bytes, "CP1251"); text && known_units(*text) > western)
    return {std::move(*text), "Windows-1251"};
  return {from_windows_1252(bytes), "Latin-1"};
}

}  // namespace data
