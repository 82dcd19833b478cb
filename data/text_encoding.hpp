#pragma once
// The encodings that instruments and spreadsheets write, brought to UTF-8.
#include <cstdint>
#include <string>
#include <string_view>

namespace data {

struct CodePoint {
  std::uint32_t code = 0;
  std::size_t length = 1;  ///< bytes
  bool valid = false;      ///< one byte of what is no UTF-8 has length 1
};
/// The character that begins at `at`. Overlong forms, surrogates and what is beyond U+10FFFF are not valid.
CodePoint utf8_at(std::string_view text, std::size_t at);

bool is_utf8(std::string_view text);

struct DecodedText {
  std::string text;  ///< UTF-8 without byte-order mark
  std::string took;  ///< "UTF-16 (little endian)", "Latin-1"; empty for plain UTF-8
};

/// Finds the encoding by the byte-order mark. Without a mark it is UTF-16 by the zeros of its ASCII characters, else
/// UTF-8 where the bytes are valid; else Shift-JIS where all of them are and hold kana or kanji; else GBK or EUC-KR
/// where all are pairs of these; else Windows-1251 where more units in brackets are known so; else Latin-1 (as
/// Windows-1252 extends it). Throws InputError (65) for UTF-32, for UTF-16 that is cut off within a character, and for
/// what is no text (`name` in the message).
DecodedText decode_text(std::string_view bytes, const std::string& name);

}  // namespace data
