#pragma once
// Texts as names of files. A text of a study or a table may hold a path, a quote or a line end; a file's name made of
// it lies in the folder that it was meant for and means nothing to a shell or to gnuplot.
#include <string>
#include <string_view>

namespace data {

/// Whether the text can stand in a file's name as it is: ASCII letters, digits, '-', '_' and '.', beginning with a
/// letter, a digit or '_', at most 100 characters.
bool is_file_name(std::string_view text);

/// The text itself when it can stand in a file's name. If not, what can is kept, the rest becomes '_', and a few digits
/// of the text's hash follow, so that different texts give different names.
std::string file_name(std::string_view text);

/// A word of a command line as a shell reads it: quoted where it must be.
std::string shell_word(std::string_view text);

}  // namespace data
