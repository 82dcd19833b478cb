#pragma once
// Numbers as instruments, spreadsheets and other languages write them.
#include <optional>
#include <string>
#include <string_view>

namespace data {

enum class DecimalMark { point, comma };

/// The number as a plain decimal ("-1234.5e-3", what std::from_chars reads), or nothing where the text is no number.
/// Besides plain numbers it takes a leading plus, a Unicode minus, Fortran's exponents (1.0D+00, 1.0-100), thousands
/// parted by an apostrophe or a hard blank, and, where the number has both marks, by the mark that is not the decimal
/// one.
std::optional<std::string> plain_number(std::string_view text, DecimalMark mark);

/// A number and what stands behind it: "2e-18" and "J" of "2e-18 J". Blanks around either, and a plus, are taken off.
struct NumberWithUnit {
  std::string digits;  ///< what std::from_chars reads
  double value = 0.0;
  std::string unit;
};
/// None where the text begins with no number that a double can hold.
std::optional<NumberWithUnit> number_with_unit(std::string_view text);

/// Whether the text says that there is no value: empty, nan, N/A, -, ---.--, #N/A, #####, ?, NULL, 1.#QNAN, ****, and
/// what historians write in its place (Bad, No Data, I/O Timeout): docs/files.md has all.
bool is_missing(std::string_view text);

/// Whether the text says that a meter was beyond its range: OL, OVL, Over, +++++, inf.
bool is_overload(std::string_view text);

/// What a number with a comma or a point in it says about the decimal mark.
enum class Evidence {
  none,  ///< neither mark, or no number
  point,
  comma,        ///< the comma is the decimal mark
  maybe_point,  ///< 1.234
  maybe_comma,  ///< 1,234: thousands or decimals
};
Evidence decimal_evidence(std::string_view text);

/// "1 run", "2 runs".
std::string counted(std::size_t count, std::string_view what);

/// The text without blanks, hard ones too, at both ends.
std::string_view trimmed(std::string_view text);

/// The text with ASCII letters in lower case; all other bytes are as they are.
std::string lower_case(std::string_view text);

/// Replaces every `from` in the text by `to`.
void replace_all(std::string& text, std::string_view from, std::string_view to);

}  // namespace data
