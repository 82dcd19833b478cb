#pragma once
// How the columns of a text table are parted.
#include <string>
#include <string_view>
#include <vector>

namespace data {

struct Dialect {
  char separator = ',';   ///< ',', ';', tab, '|' or, for blanks in any number, ' '
  std::size_t begin = 0;  ///< where the table's text begins, behind a line "sep=;"
  int first_line = 1;     ///< the line in the file at which `begin` lies
};

/// Finds how the columns are parted. Of the separators that part a heading and the lines below it into equally many
/// fields, the one is taken whose fields are numbers most often. "sep=;" in the first line decides.
Dialect find_dialect(std::string_view text);

/// "semicolons", for messages; nothing for the comma.
std::string separator_name(char separator);

/// Whether a line is a comment: it begins with '#', '%' or "//". `rest` is what follows the sign.
bool is_comment(std::string_view line, std::string_view& rest);

/// The fields of one line, quotes taken off; a quoted field ends with its line here. For a look ahead and for headings
/// in comments.
std::vector<std::string> split_line(std::string_view line, char separator);

}  // namespace data
